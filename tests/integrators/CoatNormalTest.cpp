// CoatNormalTest.cpp - what clear coats with normals of their own mirror. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/integrators/MaterialDetails.h"

#include "osgRayTrace/shading/Fresnel.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns a body that reflects nothing but by its coat.
Material blackBody()
{
    Material black = lambert(Vec3(0.0f));
    black.ior = 1.0f;
    return black;
}

/// Returns the direction of a mirror image that is turned by an angle towards +x.
Vec3 turned(double degrees)
{
    const auto angle = static_cast<float>(degrees * M_PI / 180.0);
    return Vec3(std::sin(angle), 0.0f, std::cos(angle));
}

/// Returns a lamp around the direction from the origin, of radiance 1.
void addLamp(SceneBuilder& builder, Vec3 direction)
{
    const Vec3 across(0, 1, 0), other = glm::cross(across, direction);
    builder.add(quadMesh(direction * 2.0f - 0.1f * (across + other), 0.2f * across, 0.2f * other),
                lamp(Vec3(1.0f)));
}

/// Returns what is seen from above of a coated quad that texture 0 turns and texture 1 turns the
/// coat of, kInvalid for none, below a lamp in a direction.
double seen(const MaterialDetail& detail, Vec3 lampDirection, IntegratorKind kind, Vec2 s, Vec2 t)
{
    SceneBuilder builder;
    builder.scene->textures = {tiltedTexel(30.0), tiltedTexel(10.0)};
    builder.add(mappedQuad(s, t), withDetail(blackBody(), detail));
    addLamp(builder, lampDirection);
    // The eye is below the lamps.
    const View view = perspectiveView({0, 0, 1}, {0, 0, 0}, {0, 1, 0}, 0.5, 4, 4);
    return double(render(builder.build(), view, optionsOf(kind), 1).mean().y);
}

} // namespace

TEST_CASE("coat normal: the coat mirrors by its own map, or by the normals of the mesh",
          "[integrators]")
{
    MaterialDetail own, both, bare, neither;
    neither.clearcoat = 1.0f;
    own = bare = neither;
    own.textures[kClearcoatNormalRole] = 1;
    both = own;
    both.textures[kNormalRole] = 0;
    bare.textures[kNormalRole] = 0;
    const Vec2 s(1, 0), t(0, 1);
    const double tilted =
        double(fresnelDielectric(static_cast<float>(std::cos(10.0 * M_PI / 180.0)), 1.5f));
    for (const IntegratorKind kind : kKinds)
    {
        CAPTURE(int(kind));
        for (const MaterialDetail& detail : {own, both})
        {
            CHECK(seen(detail, turned(20.0), kind, s, t) == Approx(tilted).epsilon(1e-3));
            CHECK(seen(detail, turned(0.0), kind, s, t) == 0.0);
            CHECK(seen(detail, turned(60.0), kind, s, t) == 0.0);
            CHECK(seen(detail, turned(-20.0), kind, -s, t) == Approx(tilted).epsilon(1e-3));
        }
        for (const MaterialDetail& detail : {bare, neither})
        {
            CHECK(seen(detail, turned(0.0), kind, s, t) == Approx(0.04).epsilon(1e-3));
            CHECK(seen(detail, turned(60.0), kind, s, t) == 0.0);
        }
        MaterialDetail doubled = own;
        doubled.clearcoatNormalScale = 2.0f;
        const double angle = 2.0 * std::atan(2.0 * std::tan(10.0 * M_PI / 180.0)) * 180.0 / M_PI;
        CHECK(seen(doubled, turned(angle), kind, s, t) > 0.04);
        doubled.clearcoatNormalScale = 0.0f;
        CHECK(seen(doubled, turned(0.0), kind, s, t) == Approx(0.04).epsilon(1e-3));
    }
}

TEST_CASE("coat normal: the coat of a thin wall has the normals of the wall", "[integrators]")
{
    MaterialDetail detail;
    detail.clearcoat = 1.0f;
    detail.textures[kClearcoatNormalRole] = 1;
    Material wall = glass(1.5f);
    wall.detail = std::make_shared<MaterialDetail>(detail);
    CHECK(hasCoatNormals(wall));
    detail.thinWalled = true;
    wall.detail = std::make_shared<MaterialDetail>(detail);
    CHECK_FALSE(hasCoatNormals(wall));
}

TEST_CASE("coat normal: photons and paths find the same light", "[integrators][statistics][long]")
{
    // A wall is lit by what the turned coat of a floor sends there.
    for (const float roughness : {0.0f, 0.4f})
    {
        MaterialDetail detail;
        detail.clearcoat = 1.0f;
        detail.clearcoatRoughness = roughness;
        detail.textures[kClearcoatNormalRole] = 0;
        SceneBuilder builder;
        builder.scene->textures = {tiltedTexel(-15.0)};
        builder.add(mappedQuad({1, 0}, {0, 1}), withDetail(lambert(Vec3(0.5f)), detail));
        builder.add(quadMesh({-1, -1, 0}, {0, 2, 0}, {0, 0, 4}), lambert(Vec3(0.7f)));
        builder.addQuadLight({-0.3f, 0.3f, 1.9f}, {0.6f, 0, 0}, {0, -0.6f, 0}, Vec3(5.0f));
        const auto scene = builder.build();
        const View view = perspectiveView({1.5, 0, 2.5}, {-1, 0, 2.5}, {0, 1, 0}, 30.0, 24, 24);
        const Estimate paths = measure(scene, view, optionsOf(IntegratorKind::Path), 64);
        RenderOptions options = optionsOf(IntegratorKind::Sppm);
        options.photons = 20000;
        const Estimate photons = measure(scene, view, options, 20);
        CAPTURE(roughness, paths.mean(), photons.mean());
        CHECK(paths.mean() > 0.001);
        const double spread = 4.0 * std::hypot(paths.standardError(), photons.standardError());
        CHECK(spread < 0.05 * paths.mean());
        CHECK(std::abs(paths.mean() - photons.mean()) < spread + 0.02 * paths.mean());
    }
}
