// CoincidentTest.cpp - the visible one of several surfaces in one place is always the same. Layer:
// tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/stability/geometry/Compare.h"

#include <tbb/global_control.h>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kPixels = 96;

/// Returns a wavy grid of 2 * cells^2 triangles around the origin.
std::shared_ptr<Mesh> gridMesh(int cells)
{
    std::vector<Vec3> positions;
    std::vector<UVec3> triangles;
    for (int y = 0; y <= cells; ++y)
        for (int x = 0; x <= cells; ++x)
        {
            const float u = 2.0f * static_cast<float>(x) / static_cast<float>(cells) - 1.0f;
            const float v = 2.0f * static_cast<float>(y) / static_cast<float>(cells) - 1.0f;
            positions.emplace_back(u, v, 0.2f * std::sin(3.0f * u) * std::cos(2.0f * v));
        }
    const auto at = [cells](int x, int y) { return static_cast<uint32_t>(y * (cells + 1) + x); };
    for (int y = 0; y < cells; ++y)
        for (int x = 0; x < cells; ++x)
        {
            triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
            triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
        }
    return newMesh(std::move(positions), std::move(triangles));
}

View obliqueView(int pixels = kPixels)
{
    return perspectiveView({1.5, -2.5, 2.0}, {0, 0, 0}, {0, 0, 1}, 35.0, pixels, pixels);
}

enum class Placing
{
    OneMesh,   ///< all triangles in engine space
    Instances, ///< Embree instances of two meshes
};

/// Returns a red and a green grid in the same place, both of which emit light.
SceneBuilder redAndGreen(int cells, Placing placing)
{
    SceneBuilder builder;
    for (const Vec3& radiance : {Vec3(1, 0, 0), Vec3(0, 1, 0)})
    {
        Instance& instance = builder.scene->instances[builder.add(gridMesh(cells), lamp(radiance))];
        instance.placed = placing == Placing::Instances;
    }
    return builder;
}

struct Seen
{
    int red = 0, green = 0, mixed = 0;
};

Seen seenIn(const Picture& picture)
{
    Seen seen;
    for (int i = 0; i < picture.width * picture.height; ++i)
    {
        const Vec3 c = picture.at(i % picture.width, i / picture.width);
        seen.red += c.x > 0.0f && c.y == 0.0f;
        seen.green += c.y > 0.0f && c.x == 0.0f;
        seen.mixed += c.x > 0.0f && c.y > 0.0f;
    }
    return seen;
}

/// Returns a block on a floor below a light, with each triangle of the block this many times.
SceneBuilder repeated(int times)
{
    SceneBuilder builder;
    builder.add(quadMesh({-4, -4, -0.5f}, {8, 0, 0}, {0, 8, 0}), lambert(Vec3(0.7f)));
    const auto box = boxMesh(Vec3(-0.4f), Vec3(0.4f, 0.4f, 0.6f));
    std::vector<UVec3> triangles;
    for (int i = 0; i < times; ++i)
        triangles.insert(triangles.end(), box->triangles.begin(), box->triangles.end());
    builder.add(newMesh({box->positions.begin(), box->positions.end()}, std::move(triangles)),
                lambert(Vec3(0.5f)));
    builder.addQuadLight(Vec3(-1, -1, 3), Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(5.0f));
    return builder;
}

} // namespace

TEST_CASE("stability 10: of two faces in one place the same is seen everywhere and always",
          "[stability]")
{
    const tbb::global_control sixteen(tbb::global_control::max_allowed_parallelism, 16);
    for (const Placing placing : {Placing::OneMesh, Placing::Instances})
    {
        for (const int cells : {1, 3, 64})
        {
            for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
            {
                CAPTURE(int(placing), cells, int(kind));
                const Picture first = render(redAndGreen(cells, placing).build(1), obliqueView(),
                                             optionsOf(kind), 4, 1);
                const Seen seen = seenIn(first);
                CAPTURE(seen.red, seen.green, seen.mixed);
                CHECK(seen.red + seen.green > kPixels * kPixels / 10);
                CHECK(seen.mixed == 0);
                CHECK((seen.red == 0 || seen.green == 0));
                for (const int threads : {1, 2, 16})
                {
                    const auto again = redAndGreen(cells, placing).build(threads);
                    CHECK(differing(render(again, obliqueView(), optionsOf(kind), 4, threads),
                                    first) == 0);
                }
            }
        }
    }
}

TEST_CASE("stability 11: a thousand copies of each triangle look like one", "[stability]")
{
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
    {
        const Picture one = render(repeated(1).build(), obliqueView(), optionsOf(kind), 4);
        CHECK(one.mean().y > 0.03f);
        const auto thousand = repeated(1000).build();
        CHECK(differing(render(thousand, obliqueView(), optionsOf(kind), 4), one) == 0);
        // The tree must not grow without bounds because the triangles cannot be separated.
        CHECK(thousand->statistics().embreeBytes < 12000u * 500u);
    }
}

TEST_CASE("stability 11: 1e5 triangles around one centre look like the largest", "[stability]")
{
    // The triangles are nested in one plane, the largest last, so that none may be left out. The
    // BVH takes 0.04 s on one core, which the test does not check.
    const auto nested = [](int count)
    {
        std::vector<Vec3> positions;
        std::vector<UVec3> triangles;
        for (int i = 0; i < count; ++i)
        {
            const float s = 1.0f - 0.9f * static_cast<float>(count - 1 - i) / 100000.0f;
            const auto first = static_cast<uint32_t>(positions.size());
            positions.insert(positions.end(),
                             {Vec3(s, 0, 0), Vec3(-0.5f * s, s, 0), Vec3(-0.5f * s, -s, 0)});
            triangles.push_back({first, first + 1, first + 2});
        }
        SceneBuilder builder;
        builder.add(newMesh(std::move(positions), std::move(triangles)), lambert(Vec3(0.5f)));
        builder.addLight(pointLight(Vec3(0, 0, 3)));
        return builder.build();
    };
    const auto many = nested(100000);
    const Picture one = render(nested(1), obliqueView(), optionsOf(IntegratorKind::Path), 1);
    const Picture all = render(many, obliqueView(), optionsOf(IntegratorKind::Path), 1);
    CHECK(one.mean().y > 0.005f);
    double worst = 0.0;
    for (std::size_t i = 0; i < one.rgba.size(); ++i)
        worst = std::max(worst, std::abs(double(one.rgba[i]) - double(all.rgba[i])));
    CHECK(worst <= 1e-6);
    CHECK(many->statistics().embreeBytes < 100000u * 500u);
}
