// NormalMapTest.cpp - normal maps turn surfaces, on any mesh and instance. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/integrators/MaterialDetails.h"

#include <glm/gtc/matrix_transform.hpp>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns the radiance of a white mapped quad in slanted light from the side of +x.
double litMap(const std::shared_ptr<Mesh>& mesh, const std::shared_ptr<const Texture>& texture,
              IntegratorKind kind, const Mat4* placed = nullptr)
{
    SceneBuilder builder;
    builder.scene->textures = {texture};
    const uint32_t instance = builder.add(mesh, mappedMaterial(lambert(Vec3(1.0f))));
    if (placed)
    {
        Instance& use = builder.scene->instances[instance];
        use.placed = true;
        use.engineFromLocal = {Mat3(*placed), Vec3((*placed)[3])};
        use.mirrored = glm::determinant(Mat3(*placed)) < 0.0f;
    }
    builder.addLight(slanted(1.0f));
    return double(render(builder.build(), fromAbove(), optionsOf(kind), 1).mean().y);
}

} // namespace

TEST_CASE("normal map: bumps look the way that texture coordinates go, also mirrored",
          "[integrators]")
{
    const auto texture = tiltedTexel(30.0);
    const Vec2 s(1, 0), t(0, 1);
    for (const IntegratorKind kind : kKinds)
    {
        CAPTURE(int(kind));
        // The light is 45 degrees off the surface's normal, and 15 or 75 off the tilted one.
        CHECK(litMap(mappedQuad(s, t), texture, kind) == Approx(cosineOf(15.0)).epsilon(1e-4));
        CHECK(litMap(mappedQuad(-s, t), texture, kind) == Approx(cosineOf(75.0)).epsilon(1e-4));
        CHECK(litMap(mappedQuad(s, -t), texture, kind) == Approx(cosineOf(15.0)).epsilon(1e-4));
        // Where s goes along y, the tilt is out of the plane of the light.
        const double across = cosineOf(30.0) * cosineOf(45.0);
        CHECK(litMap(mappedQuad(t, s), texture, kind) == Approx(across).epsilon(1e-4));
        CHECK(litMap(mappedQuad({0, 0}, {0, 0}), texture, kind) ==
              Approx(cosineOf(45.0)).epsilon(1e-4)); // coordinates without area: no map
        // A tilt along t follows t, whatever the sense in which coordinates wind.
        const auto alongT = texel(Vec4(0.5f, 0.75f, 0.5f + 0.5f * float(cosineOf(30.0)), 1.0f));
        CHECK(litMap(mappedQuad(t, s), alongT, kind) == Approx(cosineOf(15.0)).epsilon(1e-4));
        CHECK(litMap(mappedQuad(-t, s), alongT, kind) == Approx(cosineOf(75.0)).epsilon(1e-4));
        CHECK(litMap(mappedQuad(t, -s), alongT, kind) == Approx(cosineOf(15.0)).epsilon(1e-4));
    }
}

TEST_CASE("normal map: tangents of the mesh go before, and instances turn them", "[integrators]")
{
    const Vec2 s(1, 0), t(0, 1);
    const auto alongT = texel(Vec4(0.5f, 0.75f, 0.5f + 0.5f * float(cosineOf(30.0)), 1.0f));
    const auto withTangents = [&](Vec4 tangent)
    {
        const auto mesh = mappedQuad(s, t);
        mesh->tangents = std::vector<Vec4>(4, tangent);
        return mesh;
    };
    const auto path = IntegratorKind::Path;
    // The bitangent is w cross(normal, tangent): along +x for the tangent -y and w = 1.
    CHECK(litMap(withTangents({0, -3, 0, 1}), alongT, path) ==
          Approx(cosineOf(15.0)).epsilon(1e-4));
    CHECK(litMap(withTangents({0, -3, 0, -1}), alongT, path) ==
          Approx(cosineOf(75.0)).epsilon(1e-4));
    CHECK(litMap(withTangents({1, 0, 0, 1}), tiltedTexel(30.0), path) ==
          Approx(cosineOf(15.0)).epsilon(1e-4));

    const Mat4 half = glm::rotate(Mat4(1.0f), static_cast<float>(M_PI), Vec3(0, 0, 1));
    const Mat4 mirror = glm::scale(Mat4(1.0f), Vec3(-1, 1, 1));
    for (const auto& mesh : {mappedQuad(s, t), withTangents({1, 0, 0, 1})})
    {
        CHECK(litMap(mesh, tiltedTexel(30.0), path, &half) == Approx(cosineOf(75.0)).epsilon(1e-4));
        CHECK(litMap(mesh, tiltedTexel(30.0), path, &mirror) ==
              Approx(cosineOf(75.0)).epsilon(1e-4));
    }
    const auto turned = withTangents({0, -1, 0, 1}); // bitangent +x, which the mirror turns to -x
    CHECK(litMap(turned, alongT, path, &mirror) == Approx(cosineOf(75.0)).epsilon(1e-4));
}

TEST_CASE("normal map: no light comes through a surface, and mirrors have no black bumps",
          "[integrators]")
{
    for (const IntegratorKind kind : kKinds)
    {
        SceneBuilder builder;
        builder.scene->textures = {tiltedTexel(80.0)};
        builder.add(mappedQuad({1, 0}, {0, 1}), mappedMaterial(lambert(Vec3(1.0f))));
        Light below = slanted(1.0f);
        below.direction = glm::normalize(Vec3(-1.0f, 0.0f, 0.1f));
        builder.addLight(below);
        CHECK(render(builder.build(), fromAbove(), optionsOf(kind), 4).mean() == Vec3(0.0f));

        SceneBuilder room;
        room.scene->textures = {tiltedTexel(60.0)};
        room.add(boxMesh(Vec3(-3.0f), Vec3(3.0f)), lamp(Vec3(1.0f)));
        room.add(mappedQuad({1, 0}, {0, 1}), mappedMaterial(mirror(Vec3(1.0f))));
        for (const double x : {-2.0, 0.1, 2.0})
        {
            const View view = perspectiveView({x, 0.3, 1.0}, {0, 0, 0}, {0, 1, 0}, 20.0, 16, 16);
            CHECK(render(room.build(), view, optionsOf(kind), 1).mean().y ==
                  Approx(1.0).epsilon(1e-5));
        }
    }
}
