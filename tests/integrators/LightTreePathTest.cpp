// LightTreePathTest.cpp - pictures of many lamps: means compared with sums of Lambert's formula,
// with photons and with other threads; lamps that move; a mesh whose texture shines in one corner.
// SPDX-License-Identifier: MIT
#include "tests/integrators/Measure.h"

#include "osgRayTrace/shading/LightTable.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns the corners of square lamps of 0.2 that shine down.
std::vector<Vec3> corners(int count, uint32_t seed)
{
    Uniform random(seed);
    std::vector<Vec3> result;
    for (int i = 0; i < count; ++i)
        result.emplace_back(random.between(-8, 8), random.between(-8, 8), random.between(1, 3));
    return result;
}

constexpr float kSide = 0.2f;

enum class Emitter
{
    Parallelogram,
    Mesh,       ///< one mesh of two triangles a lamp, all of them in one light
    PlacedMesh, ///< the same with 32 triangles a lamp, which a transform has turned and enlarged
};

/// Adds a square of n x n quads.
void addGrid(Vec3 corner, Vec3 u, Vec3 v, uint32_t n, std::vector<Vec3>& positions,
             std::vector<UVec3>& triangles)
{
    const auto first = static_cast<uint32_t>(positions.size());
    const auto step = 1.0f / static_cast<float>(n);
    for (uint32_t j = 0; j <= n; ++j)
        for (uint32_t i = 0; i <= n; ++i)
            positions.push_back(corner + u * (step * static_cast<float>(i)) +
                                v * (step * static_cast<float>(j)));
    for (uint32_t j = 0; j < n; ++j)
        for (uint32_t i = 0; i < n; ++i)
        {
            const uint32_t a = first + j * (n + 1) + i, b = a + n + 1;
            triangles.emplace_back(a, a + 1, b + 1);
            triangles.emplace_back(a, b + 1, b);
        }
}

SceneBuilder under(const std::vector<Vec3>& corners, Emitter emitter)
{
    SceneBuilder builder;
    builder.add(quadMesh({-10, -10, 0}, {20, 0, 0}, {0, 20, 0}), lambert(Vec3(0.5f)));
    const Vec3 u(0, kSide, 0), v(kSide, 0, 0);
    std::vector<Vec3> positions;
    std::vector<UVec3> triangles;
    for (const Vec3& corner : corners)
    {
        if (emitter == Emitter::Parallelogram) builder.addQuadLight(corner, u, v, Vec3(1.0f));
        addGrid(corner, u, v, emitter == Emitter::PlacedMesh ? 4 : 1, positions, triangles);
    }
    if (emitter == Emitter::Parallelogram) return builder;
    Affine place;
    if (emitter == Emitter::PlacedMesh)
    {
        place.linear = Mat3(glm::rotate(glm::mat4(1.0f), 0.5f, Vec3(0.6f, 0.0f, 0.8f))) * 2.0f;
        place.translation = Vec3(1, 2, 3);
        const Mat3 inverse = glm::inverse(place.linear);
        for (Vec3& p : positions)
            p = inverse * (p - place.translation);
    }
    const uint32_t number = builder.addEmissive(newMesh(positions, triangles), lamp(Vec3(1.0f)));
    builder.scene->instances[number].placed = emitter == Emitter::PlacedMesh;
    builder.scene->instances[number].engineFromLocal = place;
    return builder;
}

/// Returns the irradiance of radiance 1 from a horizontal rectangle at the origin, whose normal is
/// +z [Lambert 1760].
double irradiance(Vec3d corner, double x, double y)
{
    const Vec3d p[4] = {corner, corner + Vec3d(x, 0, 0), corner + Vec3d(x, y, 0),
                        corner + Vec3d(0, y, 0)};
    double sum = 0.0;
    for (int k = 0; k < 4; ++k)
    {
        const Vec3d a = glm::normalize(p[k]), b = glm::normalize(p[(k + 1) % 4]);
        const Vec3d c = glm::cross(a, b);
        const double length = glm::length(c);
        sum += std::atan2(length, glm::dot(a, b)) * c.z / length;
    }
    return 0.5 * std::abs(sum);
}

double irradianceOf(const std::vector<Vec3>& corners)
{
    double sum = 0.0;
    for (const Vec3& corner : corners)
        sum += irradiance(Vec3d(corner), kSide, kSide);
    return sum;
}

/// Lamps hide each other at times, so those near the line to another one are left out.
std::vector<Vec3> apart(std::vector<Vec3> corners)
{
    std::vector<Vec3> kept;
    for (const Vec3& c : corners)
    {
        const Vec3 a = glm::normalize(c + Vec3(0.5f * kSide, 0.5f * kSide, 0.0f));
        bool clear = true;
        for (const Vec3& k : kept)
        {
            const Vec3 b = glm::normalize(k + Vec3(0.5f * kSide, 0.5f * kSide, 0.0f));
            const float angles = kSide / glm::length(c) + kSide / glm::length(k);
            clear = clear && glm::length(a - b) > angles;
        }
        if (clear) kept.push_back(c);
    }
    return kept;
}

View originView(int pixels = 8)
{
    return patchView({0, 0, 0}, {0, 0, 1}, 1e-3, pixels);
}

} // namespace

TEST_CASE("light tree: many lamps give the sum of Lambert's formulas",
          "[integrators][statistics][long]")
{
    const std::vector<Vec3> lamps = apart(corners(400, 1));
    REQUIRE(lamps.size() > 100);
    const double exact = 0.5 * irradianceOf(lamps) / M_PI;
    for (const Emitter emitter : {Emitter::Parallelogram, Emitter::Mesh, Emitter::PlacedMesh})
    {
        const auto traced = under(lamps, emitter).build();
        REQUIRE(traced->lights().tree());
        CHECK(traced->lights().tree()->placed().size() == (emitter == Emitter::PlacedMesh));
        // The estimators of light sampling alone and with the light that paths meet by chance.
        for (const IntegratorKind kind : {IntegratorKind::Whitted, IntegratorKind::Path})
        {
            if (kind == IntegratorKind::Whitted && emitter != Emitter::Parallelogram)
                continue; // one light
            const Estimate radiance = measure(traced, originView(), optionsOf(kind, 1), 32);
            CAPTURE(int(emitter), int(kind), radiance.mean(), radiance.standardError(), exact);
            CHECK(radiance.agrees(exact, 2e-6));
            CHECK(radiance.standardError() < 5e-3 * exact);
        }
    }
}

TEST_CASE("light tree: pictures are equal for any number of threads", "[integrators]")
{
    const auto traced = under(corners(200, 2), Emitter::Parallelogram).build();
    const View view = perspectiveView({0, -9, 4}, {0, 0, 0}, {0, 0, 1}, 60, 48, 32);
    for (const IntegratorKind kind : {IntegratorKind::Whitted, IntegratorKind::Path})
    {
        const Picture one = render(traced, view, optionsOf(kind, 4), 2, 1);
        CHECK(one.mean().y > 0.0f);
        for (const int threads : {2, 16})
            CHECK(render(traced, view, optionsOf(kind, 4), 2, threads).rgba == one.rgba);
    }
}

TEST_CASE("light tree: lamps that have moved shine as in a scene of their own",
          "[integrators][statistics]")
{
    std::vector<Vec3> lamps = apart(corners(200, 3));
    const auto before = under(lamps, Emitter::Parallelogram).build();
    for (Vec3& lamp : lamps)
        lamp *= 1.25f; // directions stay, so lamps do not come to hide each other
    const SceneBuilder moved = under(lamps, Emitter::Parallelogram);
    moved.scene->changed = 1;
    const auto after = TracedScene::build(moved.scene, std::make_shared<Workers>(1), before);
    REQUIRE(after->lights().tree() != before->lights().tree());
    const Estimate radiance = measure(after, originView(), optionsOf(IntegratorKind::Path, 1), 32);
    CAPTURE(radiance.mean(), radiance.standardError());
    CHECK(radiance.agrees(0.5 * irradianceOf(lamps) / M_PI, 2e-6));
}

TEST_CASE("light tree: paths agree with photons below a hundred lamps",
          "[integrators][statistics][long]")
{
    // Light that has left a wall is sampled by the tree at later bounces of paths, and carried by
    // photons otherwise. Both take the light that comes straight from the tree.
    SceneBuilder builder = under(corners(100, 4), Emitter::Parallelogram);
    const Vec3 x(20, 0, 0), y(0, 20, 0), z(0, 0, 4), low(-10, -10, 0), high(10, 10, 4);
    for (const auto& wall : {quadMesh(low, z, x), quadMesh(low, y, z), quadMesh(high, -x, -z),
                             quadMesh(high, -z, -y), quadMesh(high, -y, -x)})
        builder.add(wall, lambert(Vec3(0.7f)));
    const std::vector<Vec3> places = corners(20, 5);
    for (std::size_t i = 0; i < places.size(); ++i)
    {
        Light light = pointLight(places[i], Vec3(0.05f));
        if (i % 2) light.radius = 0.1f;
        builder.addLight(light);
    }
    const auto traced = builder.build();
    const View view = perspectiveView({0, -5, 3}, {0, 0, 1}, {0, 0, 1}, 60, 32, 32);
    const Estimate path = measure(traced, view, optionsOf(IntegratorKind::Path, 4), 16);
    RenderOptions options = optionsOf(IntegratorKind::Sppm, 4);
    options.photons = 1 << 14;
    const Estimate photons = measure(traced, view, options, 16);
    const double error = std::hypot(path.standardError(), photons.standardError());
    CAPTURE(path.mean(), photons.mean(), error);
    // Discs of photons lose some light along edges.
    CHECK(std::abs(path.mean() - photons.mean()) < 4.0 * error + 5e-3 * path.mean());
    CHECK(error < 2e-3 * path.mean());
}

TEST_CASE("light tree: a mesh whose texture shines in one corner", "[integrators][statistics]")
{
    // A ceiling of 24 x 24 quads with a texture of 24 x 24 texels, of which one shines. A transform
    // gives it a tree of its own.
    const bool placed = GENERATE(false, true);
    constexpr int kCells = 24;
    constexpr float kSize = 0.5f; // of a quad
    constexpr float kHeight = 2.0f;
    SceneBuilder builder;
    builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), lambert(Vec3(0.5f)));
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = kCells;
    texture->floats.assign(4 * kCells * kCells, 0.0f);
    texture->floats[0] = texture->floats[1] = texture->floats[2] = 1.0f;
    texture->linearFilter = false;
    builder.scene->textures.push_back(texture);
    std::vector<Vec3> positions;
    std::vector<Vec2> uvs;
    std::vector<UVec3> triangles;
    for (int j = 0; j <= kCells; ++j)
        for (int i = 0; i <= kCells; ++i)
        {
            positions.push_back(Vec3(kSize * float(i), kSize * float(j), kHeight) *
                                (placed ? 0.5f : 1.0f));
            uvs.emplace_back(float(i) / kCells, float(j) / kCells);
        }
    for (uint32_t j = 0; j < kCells; ++j)
        for (uint32_t i = 0; i < kCells; ++i)
        {
            const uint32_t a = j * (kCells + 1) + i;
            triangles.emplace_back(a, a + kCells + 1, a + 1);
            triangles.emplace_back(a + 1, a + kCells + 1, a + kCells + 2);
        }
    auto mesh = newMesh(positions, triangles);
    mesh->uvs = std::move(uvs);
    Material shining = lamp(Vec3(3.0f));
    shining.emissionTexture = 0;
    Instance& instance = builder.scene->instances[builder.addEmissive(mesh, shining)];
    instance.placed = placed;
    instance.engineFromLocal.linear = Mat3(2.0f);
    const auto traced = builder.build();
    const LightTable& table = traced->lights();
    REQUIRE(table.tree());
    CHECK((table.ownTree(0) != nullptr) == placed);
    float corner = 0.0f, least = 1.0f;
    for (uint32_t triangle = 0; triangle < 2 * kCells * kCells; ++triangle)
    {
        const float pmf =
            table.tree()->pmf(Vec3(0.0f), Vec3(0, 0, 1), table.emitterOf(0, triangle));
        (triangle < 2 ? corner : least) = triangle < 2 ? corner + pmf : std::min(least, pmf);
    }
    CHECK(corner > 0.3f); // by area it would be 1/400
    CHECK(least > 0.0f);
    const double exact = 0.5 * 3.0 * irradiance(Vec3d(0, 0, kHeight), kSize, kSize) / M_PI;
    const Estimate radiance = measure(traced, originView(), optionsOf(IntegratorKind::Path, 1), 32);
    CAPTURE(radiance.mean(), radiance.standardError(), exact);
    CHECK(radiance.agrees(exact, 2e-6));
    CHECK(radiance.standardError() < 5e-3 * exact);
}
