// FewLightsTest.cpp - pictures of few lamps, one of which is chosen for each shadow ray: means
// compared with the lamps one by one and with a quadrature; pictures without noise; threads.
// SPDX-License-Identifier: MIT
#include "tests/integrators/MediaScenes.h"

#include "osgRayTrace/shading/MaterialTable.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

struct Square
{
    Vec3 centre;
    float side;
    float radiance; ///< downwards
};

void add(SceneBuilder& builder, const Square& s)
{
    const float half = 0.5f * s.side;
    builder.addQuadLight(s.centre - Vec3(half, half, 0.0f), {0, s.side, 0}, {s.side, 0, 0},
                         Vec3(s.radiance));
}

/// Returns the radiance that a plane through the origin with its normal at +z sends upwards, by a
/// midpoint rule on each square.
double reflected(const TracedScene& traced, uint32_t material, const std::vector<Square>& squares)
{
    constexpr int kSteps = 200;
    const Bsdf& bsdf = traced.materials()[material].front;
    double sum = 0.0;
    for (const Square& s : squares)
    {
        const double step = double(s.side) / kSteps;
        for (int j = 0; j < kSteps; ++j)
            for (int i = 0; i < kSteps; ++i)
            {
                const Vec3d on =
                    Vec3d(s.centre) + Vec3d((i + 0.5) * step - 0.5 * double(s.side),
                                            (j + 0.5) * step - 0.5 * double(s.side), 0.0);
                const double distance = glm::length(on);
                const Vec3d wi = on / distance;
                const BsdfValue value = evalBsdf(bsdf, Vec3(0, 0, 1), Vec3(wi));
                sum += double(value.fCos.y) * double(s.radiance) * wi.z * step * step /
                       (distance * distance);
            }
    }
    return sum;
}

const std::vector<Square> kSquares = {{{0.3f, 0.0f, 1.0f}, 0.5f, 1.0f},
                                      {{-0.5f, 0.1f, 1.2f}, 0.3f, 9.0f},
                                      {{0.1f, 1.5f, 0.8f}, 0.9f, 2.0f}};

/// Adds a lamp, or a black square in its place.
void addLamp(SceneBuilder& builder, Vec3 corner, Vec3 u, Vec3 v, Vec3 radiance, bool shines)
{
    if (shines)
        builder.addQuadLight(corner, u, v, radiance);
    else
        builder.add(quadMesh(corner, u, v), lambert(Vec3(0.0f)));
}

enum class Way
{
    Clear,
    Panes, ///< a pane that leaves a part of the light hangs below a lamp
    Media, ///< air takes some of the light
};

/// Returns a ball of metal, one of rough glass and a wall, which hides a lamp from half of the
/// floor, below those of three lamps whose bits are set.
std::shared_ptr<const TracedScene> room(uint32_t lamps, Way way)
{
    SceneBuilder builder;
    builder.add(quadMesh({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}), lambert(Vec3(0.6f)));
    Material metal = mirror(Vec3(0.9f, 0.8f, 0.7f));
    metal.roughness = 0.4f;
    builder.add(sphereMesh({-0.5f, 0, 0.4f}, 0.4f, 16), metal);
    builder.add(sphereMesh({0.5f, 0, 0.4f}, 0.4f, 16), glass(1.5f, 0.5f));
    builder.add(boxMesh({-0.9f, 0.6f, 0}, {0.9f, 0.7f, 0.9f}), lambert(Vec3(0.4f)));
    addLamp(builder, {-1, -1, 2}, {0, 0.6f, 0}, {0.6f, 0, 0}, Vec3(4, 3, 2), (lamps & 1u) != 0);
    addLamp(builder, {0.4f, 1, 1}, {0, 0, 0.5f}, {0.5f, 0, 0}, Vec3(1, 6, 1), (lamps & 2u) != 0);
    addLamp(builder, {0.9f, -0.9f, 1}, {0, 0.1f, 0}, {0.1f, 0, 0}, Vec3(50), (lamps & 4u) != 0);
    if (way == Way::Panes)
    {
        Material pane = glass(1.5f);
        pane.baseColor = Vec3(1.0f, 0.4f, 0.8f);
        MaterialDetail thin;
        thin.thinWalled = true;
        pane.detail = std::make_shared<MaterialDetail>(thin);
        builder.add(quadMesh({-1.5f, -1.5f, 1.8f}, {1.5f, 0, 0}, {0, 3, 0}), pane);
    }
    if (way == Way::Media) setAtmosphere(builder, mediumOf(0.2f, 0.0f), 30.0f);
    return builder.build();
}

View roomView()
{
    return perspectiveView({0, -3, 1.6}, {0, 0, 0.3}, {0, 0, 1}, 40.0, 16, 16);
}

} // namespace

TEST_CASE("few lights: the choice among lamps in sight adds no noise", "[integrators]")
{
    // The lamps are so small that the place on a lamp adds less than 1e-3, and hardly any path
    // meets one by chance. A choice by power would be wrong by more than 100 % in each pixel.
    std::vector<Square> squares = kSquares;
    for (Square& s : squares)
    {
        s.side = 1e-3f * s.side;
        s.radiance = 1e6f * s.radiance;
    }
    Material plastic = lambert(Vec3(0.5f));
    plastic.ior = 1.5f;
    plastic.roughness = 0.6f;
    for (const Material& material : {lambert(Vec3(0.5f)), plastic})
    {
        SceneBuilder builder;
        const uint32_t plane = builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), material);
        for (const Square& s : squares)
            add(builder, s);
        const auto traced = builder.build();
        const uint32_t number = traced->scene().instances[plane].material;
        const double exact = reflected(*traced, number, squares);
        const Picture picture = render(traced, patchView({0, 0, 0}, {0, 0, 1}, 1e-4, 16),
                                       optionsOf(IntegratorKind::Path, 1), 1);
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x)
            {
                CAPTURE(x, y);
                CHECK(double(picture.at(x, y).y) == Approx(exact).epsilon(2e-3));
            }
    }
}

TEST_CASE("few lights: a glossy plane shows what a quadrature finds",
          "[integrators][statistics][long]")
{
    for (const float roughness : {0.2f, 0.5f})
    {
        SceneBuilder builder;
        Material metal = mirror(Vec3(0.9f));
        metal.roughness = roughness;
        const uint32_t plane = builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), metal);
        for (const Square& s : kSquares)
            add(builder, s);
        const auto traced = builder.build();
        REQUIRE(!traced->lights().tree());
        const double exact =
            reflected(*traced, traced->scene().instances[plane].material, kSquares);
        const Estimate radiance = measure(traced, patchView({0, 0, 0}, {0, 0, 1}, 1e-4, 16),
                                          optionsOf(IntegratorKind::Path, 1), 64);
        CAPTURE(roughness, radiance.mean(), radiance.standardError(), exact);
        CHECK(radiance.agrees(exact, 1e-4 * exact));
        CHECK(radiance.standardError() < 3e-3 * exact);
    }
}

TEST_CASE("few lights: together they give what they give one by one",
          "[integrators][statistics][long]")
{
    for (const Way way : {Way::Clear, Way::Panes, Way::Media})
    {
        const RenderOptions options = optionsOf(IntegratorKind::Path, 4);
        double sum = 0.0, squares = 0.0;
        for (const uint32_t lamp : {1u, 2u, 4u})
        {
            const Estimate alone = measure(room(lamp, way), roomView(), options, 32);
            sum += alone.mean();
            squares += alone.standardError() * alone.standardError();
        }
        const Estimate all = measure(room(7u, way), roomView(), options, 64);
        const double error = std::sqrt(squares + all.standardError() * all.standardError());
        CAPTURE(int(way), all.mean(), all.standardError(), sum, error);
        CHECK(std::abs(all.mean() - sum) < 4.0 * error);
        CHECK(error < 0.01 * sum);
    }
}

TEST_CASE("few lights: a lamp counts once beside one of 1e10 times its power",
          "[integrators][statistics]")
{
    // Shares of the power are floats: the dim lamp's, which comes after the other's, is 0.
    SceneBuilder builder;
    const uint32_t plane =
        builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), lambert(Vec3(0.5f)));
    const Square dim{{0.0f, 0.0f, 0.5f}, 2.0f, 1.0f};
    add(builder, {{0.0f, 0.0f, -5.0f}, 100.0f, 1e7f}); // shines away from the plane
    add(builder, dim);
    const auto traced = builder.build();
    REQUIRE(traced->lights().areaLightPmf(1) == 0.0f);
    const double exact = reflected(*traced, traced->scene().instances[plane].material, {dim});
    const Estimate radiance = measure(traced, patchView({0, 0, 0}, {0, 0, 1}, 1e-4, 16),
                                      optionsOf(IntegratorKind::Path, 1), 64);
    CAPTURE(radiance.mean(), radiance.standardError(), exact);
    CHECK(radiance.agrees(exact, 1e-4 * exact)); // false alarm: 6e-5
    CHECK(radiance.standardError() < 0.01 * exact);
}

TEST_CASE("few lights: pictures are equal for any number of threads", "[integrators]")
{
    const auto traced = room(7u, Way::Clear);
    const View view = perspectiveView({0, -3, 1.6}, {0, 0, 0.3}, {0, 0, 1}, 40.0, 48, 32);
    const Picture one = render(traced, view, optionsOf(IntegratorKind::Path, 4), 2, 1);
    CHECK(one.mean().y > 0.0f);
    for (const int threads : {2, 16})
        CHECK(render(traced, view, optionsOf(IntegratorKind::Path, 4), 2, threads).rgba ==
              one.rgba);
}
