// LightDensityTest.cpp - samples of area lights have the density that they claim, for lights of any
// size and shape and for the choice between them.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"

#include "osgRayTrace/shading/LightTable.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kSamples = 400000;
constexpr int kCells = 24; ///< a side of a parallelogram

struct Quad
{
    const char* name;
    Vec3 corner, u, v;
};

/// The quads are ordinary, tiny, huge, narrow and skewed until the edges are nearly parallel.
const Quad kQuads[] = {
    {"square", {-0.5f, -0.5f, 1}, {0, 1, 0}, {1, 0, 0}},
    {"tiny", {0.1f, 0.1f, 1}, {0, 1e-4f, 0}, {1e-4f, 0, 0}},
    {"huge", {-1e4f, -1e4f, 1}, {0, 2e4f, 0}, {2e4f, 0, 0}},
    {"narrow", {-5, 0, 0.5f}, {0, 1e-3f, 0}, {10, 0, 0}},
    {"skewed", {-1, -1, 1}, {1, 1.02f, 0.3f}, {1, 1, 0}},
    {"tilted", {0.2f, -1, 0.2f}, {0, 2, 0}, {0.1f, 0, 2}},
};

const Vec3 kPoints[] = {{0, 0, 0}, {0.3f, -0.2f, 0.999f}, {4, 3, -2}, {300, 20, -50}};

/// Returns the coordinates of a point of the parallelogram's plane along its edges.
Vec2 edgeCoordinates(const Quad& quad, Vec3d point)
{
    const Vec3d u(quad.u), v(quad.v), d = point - Vec3d(quad.corner);
    const Vec3d n = glm::cross(u, v);
    const double n2 = glm::dot(n, n);
    return Vec2(glm::dot(glm::cross(d, v), n) / n2, glm::dot(glm::cross(u, d), n) / n2);
}

/// The result of samples of light 0 from p: the chi-square test over cells of equal area, and the
/// sum of 1/pdfW, which must be the solid angle of the light.
struct LightResult
{
    double fit = 1.0;
    Estimate solidAngle;
    int bad = 0;     ///< negative, zero or not finite
    int outside = 0; ///< off the light
};

LightResult sampleQuad(const LightTable& table, const Quad& quad, Vec3 p, uint32_t seed)
{
    std::vector<double> observed(kCells * kCells, 0.0);
    LightResult result;
    Uniform random(seed);
    int samples = 0;
    for (int i = 0; i < kSamples; ++i)
    {
        const float u = random(), v = random();
        const auto sample = table.sampleArea(0, p, u, v);
        result.solidAngle.add(sample ? 1.0 / sample->pdfW : 0.0);
        if (!sample) continue;
        result.bad += !(sample->pdfW > 0.0f) || !std::isfinite(sample->pdfW) ||
                      !isFinite(sample->wi) || !isFinite(sample->point);
        // The density follows from the point in which the direction meets the light, computed from
        // wi alone.
        const Vec3d n = glm::normalize(glm::cross(Vec3d(quad.u), Vec3d(quad.v)));
        const Vec3d wi(sample->wi), d = Vec3d(quad.corner) - Vec3d(p);
        const double distance = glm::dot(d, n) / glm::dot(wi, n);
        const double area = glm::length(glm::cross(Vec3d(quad.u), Vec3d(quad.v)));
        const double pdfW = distance * distance / (area * std::abs(glm::dot(wi, n)));
        const Vec2 at = edgeCoordinates(quad, Vec3d(sample->point));
        result.bad += std::abs(pdfW / sample->pdfW - 1.0) > 2e-3;
        result.outside += at.x < -1e-3f || at.y < -1e-3f || at.x > 1.001f || at.y > 1.001f;
        const auto cell = [](float x)
        { return static_cast<std::size_t>(std::clamp(x * kCells, 0.0f, kCells - 0.5f)); };
        ++observed[cell(at.y) * kCells + cell(at.x)];
        ++samples;
    }
    result.fit = chiSquareTest(
        observed, std::vector<double>(observed.size(), double(samples) / (kCells * kCells)));
    return result;
}

double solidAngle(Vec3d a, Vec3d b, Vec3d c)
{
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double numerator = std::abs(glm::dot(a, glm::cross(b, c)));
    return 2.0 * std::atan2(numerator, la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la +
                                           glm::dot(c, a) * lb);
}

} // namespace

TEST_CASE("light density: parallelograms of any size and shape", "[shading][statistics]")
{
    // Samples are uniform by area in 576 cells, and the claimed density gives the light's exact
    // solid angle. There are 1 % false alarms in all of the chi-square tests (Sidak), and 6e-5 for
    // each solid angle.
    const double significance = sidak(0.01, 6 * 4);
    uint32_t seed = 0;
    for (const Quad& quad : kQuads)
    {
        SceneBuilder builder;
        builder.addQuadLight(quad.corner, quad.u, quad.v, Vec3(1.0f), true);
        const LightTable table(*builder.scene);
        for (const Vec3& p : kPoints)
        {
            CAPTURE(quad.name, p.x, p.y, p.z);
            const LightResult result = sampleQuad(table, quad, p, ++seed);
            CHECK(result.fit > significance);
            CHECK(result.bad == 0);
            CHECK(result.outside == 0);
            const Vec3d a = Vec3d(quad.corner) - Vec3d(p), b = a + Vec3d(quad.u),
                        c = b + Vec3d(quad.v), d = a + Vec3d(quad.v);
            const double exact = solidAngle(a, b, c) + solidAngle(a, c, d);
            // Close to a huge light a few samples make the sum, and its spread tells nothing.
            const Vec3d n = glm::normalize(glm::cross(Vec3d(quad.u), Vec3d(quad.v)));
            const double extent = glm::length(Vec3d(quad.u)) + glm::length(Vec3d(quad.v));
            if (extent < 100.0 * std::abs(glm::dot(a, n)))
                CHECK(result.solidAngle.agrees(exact, 1e-4 * exact));
        }
    }
}

TEST_CASE("light density: triangles of very unequal area, cell by cell", "[shading][statistics]")
{
    // Forty triangles in a row at x = 2k have areas from 0.5 to 5e-7; each is tested in four equal
    // parts.
    std::vector<Vec3> positions;
    std::vector<UVec3> triangles;
    std::vector<double> areas;
    for (uint32_t k = 0; k < 40; ++k)
    {
        const float height = std::pow(10.0f, -6.0f * static_cast<float>(k % 13) / 12.0f);
        const Vec3 a(2.0f * static_cast<float>(k), 0, 0);
        positions.insert(positions.end(), {a, a + Vec3(1, 0, 0), a + Vec3(0, height, 0)});
        triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
        areas.push_back(0.5 * double(height));
    }
    double total = 0.0;
    for (const double area : areas)
        total += area;
    SceneBuilder builder;
    builder.addEmissive(newMesh(positions, triangles), lamp(Vec3(1.0f)));
    const LightTable table(*builder.scene);
    CHECK(table.area(0) == Approx(total));

    constexpr int kMany = 1000000;
    std::vector<double> observed(160, 0.0), expected;
    Uniform random(11);
    int outside = 0, bad = 0;
    for (int i = 0; i < kMany; ++i)
    {
        const float u = random(), v = random();
        const auto sample = table.sampleArea(0, Vec3(40, 0, 30), u, v);
        REQUIRE(sample);
        bad += !(sample->pdfW > 0.0f) || !std::isfinite(sample->pdfW);
        const auto k = static_cast<std::size_t>(std::clamp(sample->point.x / 2.0f, 0.0f, 39.0f));
        const double b = sample->point.x - 2.0 * double(k);
        const double c = sample->point.y / (2.0 * areas[k]);
        outside += b < -1e-4 || c < -0.1 || b + c > 1.1;
        const std::size_t part = b > 0.5 ? 1 : c > 0.5 ? 2 : b + c < 0.5 ? 0 : 3;
        ++observed[4 * k + part];
    }
    for (const double area : areas)
        for (int part = 0; part < 4; ++part)
            expected.push_back(kMany * area / total / 4.0);
    CHECK(outside == 0);
    CHECK(bad == 0);
    CHECK(chiSquareTest(observed, expected) > 0.01);
}

TEST_CASE("light density: lights of very unequal power are chosen as claimed",
          "[shading][statistics]")
{
    // There are 60 lights, whose powers range over twelve orders of magnitude.
    SceneBuilder builder;
    for (int k = 0; k < 60; ++k)
    {
        const float power = std::pow(10.0f, static_cast<float>(k * 7 % 13) - 6.0f);
        builder.addQuadLight({2.0f * static_cast<float>(k), 0, 0}, {1, 0, 0}, {0, 1, 0},
                             Vec3(power));
    }
    const LightTable table(*builder.scene);
    constexpr int kMany = 1000000;
    std::vector<double> observed(60, 0.0), claimed, powers;
    double total = 0.0, sum = 0.0;
    Uniform random(13);
    for (int i = 0; i < kMany; ++i)
    {
        const LightTable::Choice choice = table.chooseAreaLight(random());
        REQUIRE(choice.light < 60);
        REQUIRE(choice.pmf > 0.0f);
        REQUIRE(choice.pmf == table.areaLightPmf(choice.light));
        ++observed[choice.light];
    }
    for (uint32_t k = 0; k < 60; ++k)
    {
        sum += table.areaLightPmf(k);
        total += double(builder.scene->lights[k].radiance.x);
        claimed.push_back(kMany * double(table.areaLightPmf(k)));
    }
    for (uint32_t k = 0; k < 60; ++k)
        powers.push_back(kMany * double(builder.scene->lights[k].radiance.x) / total);
    CHECK(sum == Approx(1.0).epsilon(1e-6));
    CHECK(chiSquareTest(observed, claimed) > 0.005);
    CHECK(chiSquareTest(observed, powers) > 0.005);
}

TEST_CASE(
    "light density: a light too faint for a float's share is still sampled, or says it is not",
    "[shading]")
{
    // The light is next to one of 1e12 times its power. A share of 0 is right, because the path
    // tracer then finds all of its light by chance. A share that is claimed but never drawn would
    // lose the light.
    SceneBuilder builder;
    builder.addQuadLight({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, Vec3(1e-6f));
    builder.addQuadLight({2, 0, 0}, {1, 0, 0}, {0, 1, 0}, Vec3(1e6f));
    builder.addQuadLight({4, 0, 0}, {1, 0, 0}, {0, 1, 0}, Vec3(1e-6f));
    const LightTable table(*builder.scene);
    for (const uint32_t light : {0u, 2u})
    {
        const float pmf = table.areaLightPmf(light);
        CHECK((pmf == 0.0f || pmf > 1e-14f));
        if (pmf == 0.0f) continue;
        // The light is drawn by numbers below its share (or the highest number there is), if it
        // claims a share.
        const float u = light == 0 ? 0.5f * pmf : kOneMinusEpsilon;
        CHECK(table.chooseAreaLight(u).light == light);
    }
}
