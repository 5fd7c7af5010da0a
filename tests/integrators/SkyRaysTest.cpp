// SkyRaysTest.cpp - a sky behind a small opening: means compared with Lambert's formula and with
// surfaces that send no more rays; noise; threads.
// SPDX-License-Identifier: MIT
#include "tests/integrators/MediaScenes.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns the same surface, but one whose colour could change from point to point.
Material varying(const Material& diffuse)
{
    Material material;
    material.diffuse = diffuse.baseColor;
    material.vertexColorUse = VertexColorUse::Ambient;
    return material;
}

enum class Sky
{
    Even,
    Sun, ///< a bright spot, which samples of the sky find
};

enum class Air
{
    None,
    Clear, ///< of an extinction that nobody sees: scenes with media send no more rays
};

/// Returns a box of height 1 whose ceiling has a square opening above the middle of the floor.
std::shared_ptr<const TracedScene> boxUnder(Sky kind, float side, const Material& floor,
                                            const Material& walls, Air air = Air::None)
{
    constexpr float kHalf = 3.0f;
    const float edge = 0.5f * side, beside = kHalf - edge;
    SceneBuilder builder;
    builder.add(quadMesh({-kHalf, -kHalf, 0}, {2 * kHalf, 0, 0}, {0, 2 * kHalf, 0}), floor);
    builder.add(quadMesh({-kHalf, -kHalf, 1}, {2 * kHalf, 0, 0}, {0, beside, 0}), walls);
    builder.add(quadMesh({-kHalf, edge, 1}, {2 * kHalf, 0, 0}, {0, beside, 0}), walls);
    builder.add(quadMesh({-kHalf, -edge, 1}, {beside, 0, 0}, {0, side, 0}), walls);
    builder.add(quadMesh({edge, -edge, 1}, {beside, 0, 0}, {0, side, 0}), walls);
    for (const float x : {-kHalf, kHalf})
    {
        builder.add(quadMesh({x, -kHalf, 0}, {0, 2 * kHalf, 0}, {0, 0, 1}), walls);
        builder.add(quadMesh({-kHalf, x, 0}, {2 * kHalf, 0, 0}, {0, 0, 1}), walls);
    }
    Light sky;
    sky.kind = LightKind::Environment;
    sky.radiance = Vec3(1.0f);
    const auto radiance = [kind](Vec3d d)
    { return Vec3(kind == Sky::Sun && d.z > 0.97 && d.x > 0.0 ? 60.0f : 1.0f); };
    sky.environment.image = newEnvironment(64, 32, radiance);
    builder.addLight(sky);
    if (air == Air::Clear) setAtmosphere(builder, mediumOf(1e-9f, 0.0f), 30.0f);
    return builder.build();
}

/// Returns the irradiance below the middle of a square of radiance 1 at height 1 [Lambert 1760].
double irradiance(double side)
{
    const double a = 0.5 * side, root = std::sqrt(1.0 + a * a);
    return 4.0 * (a / root) * std::atan(a / root);
}

View floorView()
{
    return patchView({0, 0, 0}, {0, 0, 1}, 1e-3, 16);
}

} // namespace

TEST_CASE("sky rays: an opening gives what Lambert's formula says", "[integrators][statistics]")
{
    REQUIRE(irradiance(1.0) == Approx(0.75227469)); // as in AreaLightTest.cpp
    const Material black = lambert(Vec3(0.0f));
    for (const float side : {3.0f, 1.0f, 0.25f}) // of which most rays, a quarter and few find
    {
        const double exact = 0.8 * irradiance(double(side)) / M_PI;
        const auto traced = boxUnder(Sky::Even, side, lambert(Vec3(0.8f)), black);
        const Estimate radiance =
            measure(traced, floorView(), optionsOf(IntegratorKind::Path, 1), 64);
        CAPTURE(side, radiance.mean(), radiance.standardError(), exact);
        CHECK(radiance.agrees(exact, 1e-5 * exact));
        CHECK(radiance.standardError() < 0.01 * exact);
    }
}

TEST_CASE("sky rays: the mean of surfaces that send none, and less noise",
          "[integrators][statistics][long]")
{
    const View view = perspectiveView({0, -2, 0.5}, {0, 0, 0.2}, {0, 0, 1}, 50.0, 16, 16);
    for (const Sky sky : {Sky::Even, Sky::Sun})
    {
        const Material grey = lambert(Vec3(0.6f));
        const RenderOptions options = optionsOf(IntegratorKind::Path, 3);
        const Estimate none =
            measure(boxUnder(sky, 0.4f, grey, grey, Air::Clear), view, options, 128);
        for (const Material& material : {grey, varying(grey)})
        {
            const Estimate more =
                measure(boxUnder(sky, 0.4f, material, material), view, options, 64);
            const double error = std::hypot(more.standardError(), none.standardError());
            CAPTURE(int(sky), more.mean(), none.mean(), error);
            CHECK(std::abs(more.mean() - none.mean()) < 4.0 * error);
            CHECK(error < 0.02 * none.mean());
        }
    }
    // Of direct light the noise falls by nearly five; the factors of 16 seeds scatter by 1.6.
    const Material black = lambert(Vec3(0.0f)), white = lambert(Vec3(0.8f));
    const RenderOptions options = optionsOf(IntegratorKind::Path, 1);
    const Estimate none =
        measure(boxUnder(Sky::Even, 0.4f, white, black, Air::Clear), floorView(), options, 16);
    for (const Material& material : {white, varying(white)})
    {
        const Estimate more =
            measure(boxUnder(Sky::Even, 0.4f, material, black), floorView(), options, 16);
        CAPTURE(more.variance(), none.variance());
        CHECK(more.variance() < 0.6 * none.variance());
    }
}

TEST_CASE("sky rays: pictures are equal for any number of threads", "[integrators]")
{
    const Material grey = lambert(Vec3(0.6f));
    const auto traced = boxUnder(Sky::Sun, 0.4f, grey, grey);
    const View view = perspectiveView({0, -2, 0.5}, {0, 0, 0.2}, {0, 0, 1}, 50.0, 48, 32);
    const Picture one = render(traced, view, optionsOf(IntegratorKind::Path, 4), 2, 1);
    CHECK(one.mean().y > 0.0f);
    for (const int threads : {2, 16})
        CHECK(render(traced, view, optionsOf(IntegratorKind::Path, 4), 2, threads).rgba ==
              one.rgba);
}
