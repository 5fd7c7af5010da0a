// LightTableTest.cpp - sampling of area lights, and the light of other kinds.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"

#include "osgRayTrace/shading/LightTable.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns the solid angle of a triangle [Van Oosterom, Strackee 1983].
double solidAngle(Vec3d a, Vec3d b, Vec3d c)
{
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double numerator = std::abs(glm::dot(a, glm::cross(b, c)));
    return 2.0 * std::atan2(numerator, la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la +
                                           glm::dot(c, a) * lb);
}

double solidAngle(const Mesh& mesh, Vec3d from)
{
    double sum = 0.0;
    for (const UVec3& t : mesh.triangles)
        sum += solidAngle(Vec3d(mesh.positions[t.x]) - from, Vec3d(mesh.positions[t.y]) - from,
                          Vec3d(mesh.positions[t.z]) - from);
    return sum;
}

/// Returns the mean of 1/pdfW over stratified samples, which is the solid angle.
double sampledSolidAngle(const LightTable& table, Vec3 from,
                         int side = 516) // whole strata for 2 and 12 triangles
{
    double sum = 0.0;
    for (int y = 0; y < side; ++y)
    {
        for (int x = 0; x < side; ++x)
        {
            const auto sample =
                table.sampleArea(0, from, (static_cast<float>(x) + 0.5f) / static_cast<float>(side),
                                 (static_cast<float>(y) + 0.5f) / static_cast<float>(side));
            if (sample) sum += 1.0 / sample->pdfW;
        }
    }
    return sum / side / side;
}

} // namespace

TEST_CASE("area light: the density integrates to the solid angle", "[shading]")
{
    const Vec3 corner(-0.5f, -0.25f, 1.0f), u(1.0f, 0.2f, 0.1f), v(0.1f, -0.7f, 0.0f);
    for (const Vec3& from : {Vec3(0.0f), Vec3(0.7f, 0.2f, 0.1f), Vec3(3.0f, -2.0f, 0.5f)})
    {
        SceneBuilder quad;
        quad.addQuadLight(corner, u, v, Vec3(1.0f), true);
        const double exact = solidAngle(*quad.scene->meshes[0], Vec3d(from));
        CHECK(sampledSolidAngle(LightTable(*quad.scene), from) == Approx(exact).epsilon(1e-4));

        SceneBuilder mesh;
        mesh.addEmissive(quadMesh(corner, u, v), lamp(Vec3(1.0f)));
        CHECK(sampledSolidAngle(LightTable(*mesh.scene), from) == Approx(exact).epsilon(2e-3));
    }
}

TEST_CASE("area light: a closed emissive mesh is seen twice, front and back", "[shading]")
{
    SceneBuilder builder;
    builder.addEmissive(boxMesh(Vec3(-1.0f), Vec3(1.0f)), lamp(Vec3(1.0f)));
    const LightTable table(*builder.scene);
    CHECK(table.area(0) == Approx(24.0));
    CHECK(sampledSolidAngle(table, Vec3(0.0f)) == Approx(4.0 * M_PI).epsilon(2e-3));
    const Vec3 outside(3.0f, 0.5f, 0.2f);
    CHECK(sampledSolidAngle(table, outside) ==
          Approx(solidAngle(*builder.scene->meshes[0], Vec3d(outside))).epsilon(2e-3));
}

TEST_CASE("area light: one-sided lights are dark behind", "[shading]")
{
    SceneBuilder builder;
    builder.addQuadLight({0, 0, 1}, {0, 1, 0}, {1, 0, 0}, Vec3(1.0f)); // shines downwards
    const LightTable table(*builder.scene);
    const auto below = table.sampleArea(0, Vec3(0.5f, 0.5f, 0.0f), 0.25f, 0.75f);
    REQUIRE(below);
    CHECK(below->cosThetaL > 0.0f);
    CHECK(below->distance == Approx(std::sqrt(1.0 + 2.0 * 0.0625)));
    CHECK(below->pdfW == Approx(table.pdfArea(0, below->distance, below->cosThetaL)));
    CHECK(below->point.z == 1.0f);
    CHECK(std::abs(below->normal.z) == 1.0f);
    CHECK(below->offset > 0.0f); // clear of its own surface
    CHECK(below->offset < 1e-4f);
    CHECK_FALSE(table.sampleArea(0, Vec3(0.5f, 0.5f, 2.0f), 0.25f, 0.75f));
    CHECK_FALSE(table.sampleArea(0, Vec3(3.0f, 0.5f, 1.0f), 0.25f, 0.75f)); // on its plane
}

TEST_CASE("area light: triangles of a mesh are chosen by area, those without area never",
          "[shading][statistics]")
{
    // The triangles have the areas 0.5, 0, 1.5, 0; the second has two equal corners, the fourth
    // lies on a line.
    const auto mesh =
        newMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {8, 0, 0}, {5, 1, 0}, {6.5f, 0, 0}},
                {{0, 1, 2}, {0, 0, 2}, {3, 4, 5}, {3, 6, 4}});
    SceneBuilder builder;
    builder.addEmissive(mesh, lamp(Vec3(1.0f)));
    const LightTable table(*builder.scene);
    CHECK(table.area(0) == Approx(2.0));
    int first = 0, second = 0;
    Uniform random(1);
    constexpr int kSamples = 100000;
    for (int i = 0; i < kSamples; ++i)
    {
        const float u = random(), v = random();
        const auto sample = table.sampleArea(0, Vec3(2.0f, 3.0f, 4.0f), u, v);
        REQUIRE(sample);
        REQUIRE(isFinite(sample->wi));
        const Vec3 q = sample->point;
        if (q.x < 4.0f)
        {
            ++first;
            REQUIRE((q.x > -1e-4f && q.y > -1e-4f && q.x + q.y < 1.0f + 1e-4f));
        }
        else
        {
            ++second;
            REQUIRE((q.y > -1e-4f && (q.x - 5.0f) / 3.0f + q.y < 1.0f + 1e-4f));
        }
    }
    // The count is binomial with a share of 1/4; the bound is 5 sigma.
    CHECK(std::abs(first - kSamples / 4) < 5.0 * std::sqrt(kSamples * 3.0 / 16.0));
    CHECK(first + second == kSamples);
}

TEST_CASE("area light: a mesh without any area, or without radiance, is never sampled", "[shading]")
{
    SceneBuilder builder;
    builder.addEmissive(newMesh({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}, {1, 1, 1}}),
                        lamp(Vec3(1.0f)));
    builder.addEmissive(quadMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), lamp(Vec3(0.0f)));
    builder.addQuadLight({0, 0, 0}, {1, 0, 0}, {2, 0, 0}, Vec3(1.0f));
    const LightTable table(*builder.scene);
    CHECK(table.areaLights().empty());
    CHECK(table.chooseAreaLight(0.5f).light == kInvalid);
    CHECK(table.areaLightPmf(0) == 0.0f);
    CHECK_FALSE(table.sampleArea(0, Vec3(0.0f, 0.0f, 1.0f), 0.5f, 0.5f));
}

TEST_CASE("area light: placed meshes are sampled where they are, with their area there",
          "[shading]")
{
    SceneBuilder builder;
    const uint32_t index =
        builder.addEmissive(quadMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), lamp(Vec3(1.0f)));
    Instance& instance = builder.scene->instances[index];
    instance.placed = true;
    instance.engineFromLocal.linear = Mat3(3.0f);
    instance.engineFromLocal.translation = Vec3(0, 0, 10);
    const LightTable table(*builder.scene);
    CHECK(table.area(0) == Approx(9.0));
    const auto sample = table.sampleArea(0, Vec3(0.0f), 0.1f, 0.1f);
    REQUIRE(sample);
    CHECK(sample->point.z == Approx(10.0));
}

TEST_CASE("area light: lights are chosen by power", "[shading]")
{
    SceneBuilder builder;
    builder.addQuadLight({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, Vec3(1.0f));
    builder.addLight(pointLight(Vec3(0.0f)));
    builder.addQuadLight({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, Vec3(1.0f),
                         true); // two-sided: twice the power
    builder.addQuadLight({0, 0, 0}, {1, 0, 0}, {0, 5, 0}, Vec3(1.0f));
    const LightTable table(*builder.scene);
    CHECK(table.areaLights() == std::vector<uint32_t>{0, 2, 3});
    CHECK(table.deltaLights() == std::vector<uint32_t>{1});
    CHECK(table.areaLightPmf(0) == Approx(1.0 / 8.0));
    CHECK(table.areaLightPmf(2) == Approx(2.0 / 8.0));
    CHECK(table.areaLightPmf(3) == Approx(5.0 / 8.0));
    CHECK(table.chooseAreaLight(0.0f).light == 0);
    CHECK(table.chooseAreaLight(0.12f).light == 0);
    CHECK(table.chooseAreaLight(0.13f).light == 2);
    CHECK(table.chooseAreaLight(0.38f).light == 3);
    CHECK(table.chooseAreaLight(kOneMinusEpsilon).light == 3);
    CHECK(table.chooseAreaLight(0.2f).pmf == table.areaLightPmf(2));
}

TEST_CASE("delta light: attenuation and spot terms of OpenGL", "[shading]")
{
    Light light;
    light.position = Vec3(0, 0, 2);
    light.attenuationConstant = 0.5f;
    light.attenuationLinear = 0.25f;
    light.attenuationQuadratic = 0.125f;
    const DeltaLightSample plain = sampleDelta(light, Vec3(0.0f));
    CHECK(plain.attenuation == Approx(1.0 / (0.5 + 0.5 + 0.5)));
    CHECK(plain.distance == 2.0f);
    CHECK(plain.wi == Vec3(0, 0, 1));

    light.range = 4.0f; // half the range: 1 - 1/16 is left
    CHECK(sampleDelta(light, Vec3(0.0f)).attenuation == Approx(0.9375 / 1.5));
    light.range = 2.0f;
    CHECK(sampleDelta(light, Vec3(0.0f)).attenuation == 0.0f);
    light.range = 0.0f;

    light.attenuationConstant = 1.0f;
    light.attenuationLinear = light.attenuationQuadratic = 0.0f;
    light.direction = Vec3(0, 0, -1);
    light.spotCosCutoff = std::cos(glm::radians(30.0f));
    light.spotExponent = 2.0f;
    CHECK(sampleDelta(light, Vec3(0.0f)).attenuation == Approx(1.0));
    const float x = 2.0f * std::tan(glm::radians(20.0f));
    CHECK(sampleDelta(light, Vec3(x, 0, 0)).attenuation ==
          Approx(std::pow(std::cos(glm::radians(20.0)), 2.0)));
    CHECK(sampleDelta(light, Vec3(2.0f * std::tan(glm::radians(31.0f)), 0, 0)).attenuation == 0.0f);
    CHECK(sampleDelta(light, Vec3(0, 0, 4)).attenuation == 0.0f); // behind the spot

    light.kind = LightKind::Directional;
    const DeltaLightSample sun = sampleDelta(light, Vec3(7.0f));
    CHECK(sun.wi == Vec3(0, 0, 1));
    CHECK(sun.distance == kInfinity);
    CHECK(sun.attenuation == 1.0f);
}

TEST_CASE("delta light: a point at the light itself, or no fall-off at all, is safe", "[shading]")
{
    Light light = pointLight(Vec3(1.0f));
    CHECK(sampleDelta(light, Vec3(1.0f)).attenuation == 0.0f);
    light.attenuationQuadratic = 0.0f; // 1/0
    CHECK(sampleDelta(light, Vec3(0.0f)).attenuation == 0.0f);
}
