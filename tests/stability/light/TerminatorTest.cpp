// TerminatorTest.cpp - the terminator on coarse smooth-shaded bodies. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/integrators/Measure.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kPixels = 256;

/// Returns a faceted sphere of radius 1 with the normals of a sphere.
std::shared_ptr<Mesh> smoothSphere(int rows)
{
    auto mesh = sphereMesh(Vec3(0.0f), 1.0f, rows);
    mesh->normals = std::vector<Vec3>(mesh->positions.begin(), mesh->positions.end());
    return mesh;
}

Light sun(Vec3 direction)
{
    Light light;
    light.kind = LightKind::Directional;
    light.direction = glm::normalize(direction);
    light.diffuse = Vec3(1.0f);
    return light;
}

/// Returns the fixed-function counterpart of lambert(1), for which the Whitted integrator has code
/// of its own.
Material fixedFunctionWhite()
{
    Material material;
    material.diffuse = Vec3(1.0f);
    material.ambient = Vec3(0.0f);
    return material;
}

/// Returns a picture of the sphere along a ray parallel to none of its edges, lit from the side.
Picture pictureOf(int rows, const Material& material, const RenderOptions& options)
{
    SceneBuilder builder;
    builder.add(smoothSphere(rows), material);
    builder.addLight(sun({-0.9f, 0.2f, 0.35f}));
    return render(builder.build(),
                  patchView(Vec3d(0.0), glm::normalize(Vec3d(0.2, -0.9, 0.3)), 2.0, kPixels),
                  options, 4);
}

/// Returns whether the pixel is in the part of the picture that a body of the radius 0.85 covers,
/// far from any silhouette.
bool isInside(int x, int y)
{
    const double c = 0.5 * (kPixels - 1);
    return std::hypot(x - c, y - c) < 0.85 * 0.5 * kPixels;
}

/// Holds the largest step from a pixel to the next one, and the largest difference from the fine
/// sphere, both over the peak.
struct Steps
{
    double step = 0.0, difference = 0.0;
};

Steps stepsOf(const Picture& coarse, const Picture& fine)
{
    Steps steps;
    double peak = 0.0;
    for (int y = 0; y + 1 < kPixels; ++y)
    {
        for (int x = 0; x + 1 < kPixels; ++x)
        {
            if (!isInside(x, y)) continue;
            const double here = coarse.at(x, y).y;
            peak = std::max(peak, double(fine.at(x, y).y));
            steps.step = std::max(steps.step, std::abs(here - coarse.at(x + 1, y).y));
            steps.step = std::max(steps.step, std::abs(here - coarse.at(x, y + 1).y));
            steps.difference = std::max(steps.difference, std::abs(here - fine.at(x, y).y));
        }
    }
    return {steps.step / peak, steps.difference / peak};
}

RenderOptions optionsWith(IntegratorKind kind, bool correction)
{
    RenderOptions options = optionsOf(kind, 4);
    options.terminatorCorrection = correction;
    return options;
}

} // namespace

TEST_CASE("stability 53: no step where light ends on a coarse smooth sphere", "[stability]")
{
    for (const Material& material : {lambert(Vec3(1.0f)), fixedFunctionWhite()})
    {
        const Picture fine = pictureOf(1000, material, optionsWith(IntegratorKind::Whitted, true));
        for (const IntegratorKind kind : {IntegratorKind::Whitted, IntegratorKind::Path})
        {
            CAPTURE(int(material.model), int(kind));
            const Steps on = stepsOf(pictureOf(12, material, optionsWith(kind, true)), fine);
            const Steps off = stepsOf(pictureOf(12, material, optionsWith(kind, false)), fine);
            CAPTURE(on.step, on.difference, off.step, off.difference);
            CHECK(on.step < 0.02);
            CHECK(on.difference < 0.02);
            CHECK(off.step > 0.1); // the step that is corrected
        }
    }
}

namespace
{

constexpr int kSmall = 32, kTile = 8, kTiles = kSmall / kTile;

/// Returns a coarse smooth ball above a floor below a lamp, half of whose light comes in below the
/// horizon of the facets that it grazes. If sampled is true, the lamp is in the light table;
/// otherwise only bounces find it.
std::shared_ptr<const TracedScene> ballBelowLamp(const Material& material, bool sampled)
{
    SceneBuilder builder;
    builder.add(quadMesh({-2, -2, -1.05f}, {4, 0, 0}, {0, 4, 0}), lambert(Vec3(0.5f)));
    builder.add(smoothSphere(6), material);
    const auto quad = quadMesh({0.6f, -1.2f, 1.6f}, {0, 1.6f, 0}, {1.6f, 0, -0.8f});
    if (sampled)
        builder.addEmissive(quad, lamp(Vec3(4.0f)));
    else
        builder.add(quad, lamp(Vec3(4.0f)));
    return builder.build();
}

std::vector<Estimate> tileMeans(const std::shared_ptr<const TracedScene>& traced,
                                RenderOptions options, int passes)
{
    const View view = perspectiveView({-0.8, -4, 1}, {0, 0, 0}, {0, 0, 1}, 32.0, kSmall, kSmall);
    std::vector<Estimate> means(kTiles * kTiles);
    for (uint32_t seed = 0; seed < 16; ++seed)
    {
        options.seed = seed + 100 * static_cast<uint32_t>(options.integrator);
        const Picture picture = render(traced, view, options, passes);
        REQUIRE(picture.progress.droppedSamples == 0);
        for (int tile = 0; tile < kTiles * kTiles; ++tile)
        {
            double sum = 0.0;
            for (int i = 0; i < kTile * kTile; ++i)
                sum +=
                    picture.at(tile % kTiles * kTile + i % kTile, tile / kTiles * kTile + i / kTile)
                        .y;
            means[static_cast<std::size_t>(tile)].add(sum / (kTile * kTile));
        }
    }
    return means;
}

struct Difference
{
    int compared = 0, different = 0;
};

/// Counts the tiles that are more than 5 standard errors (Welch) apart, among those that are known
/// to 5 %: if only few samples find light, errors are not normal. By chance a tile is so with a
/// probability of 2e-5 (30 degrees of freedom), and one of the whole test with 2e-3.
Difference differenceOf(const std::vector<Estimate>& a, const std::vector<Estimate>& b)
{
    Difference difference;
    for (std::size_t i = 0; i < a.size(); ++i)
    {
        const double spread = std::hypot(a[i].standardError(), b[i].standardError());
        if (!(spread < 0.05 * a[i].mean())) continue;
        ++difference.compared;
        difference.different +=
            std::abs(a[i].mean() - b[i].mean()) > 5.0 * spread + 1e-5 * a[i].mean();
    }
    return difference;
}

Material plastic()
{
    Material material = lambert(Vec3(0.8f));
    material.ior = 1.5f;
    material.roughness = 0.5f;
    return material;
}

} // namespace

TEST_CASE("stability 53: integrators agree with the correction, and without it", "[stability]")
{
    for (const Material& material : {lambert(Vec3(0.8f)), plastic()})
    {
        const auto sampled = ballBelowLamp(material, true), found = ballBelowLamp(material, false);
        std::vector<Estimate> whitted[2];
        for (const bool correction : {false, true})
        {
            CAPTURE(material.ior, correction);
            RenderOptions once = optionsWith(IntegratorKind::Path, correction);
            once.maxBounces = 1;
            const auto path = tileMeans(sampled, once, 64);
            whitted[correction] =
                tileMeans(sampled, optionsWith(IntegratorKind::Whitted, correction), 16);
            // Light samples and chance hits must start at the same point, or their weights do not
            // sum to 1.
            for (const auto& other : {whitted[correction], tileMeans(found, once, 256)})
            {
                const Difference difference = differenceOf(path, other);
                CHECK(difference.different == 0);
                CHECK(difference.compared >= 10);
            }
        }
        CHECK(differenceOf(whitted[0], whitted[1]).different >= 4);
    }
}

TEST_CASE("stability 53: a coarse smooth ball in a white room gives back its albedo", "[stability]")
{
    // No facet hides light from another: by its normals the ball is convex.
    SceneBuilder builder;
    builder.add(boxMesh(Vec3(-9.0f), Vec3(9.0f)), lamp(Vec3(1.0f)));
    builder.add(smoothSphere(12), lambert(Vec3(0.8f)));
    const auto traced = builder.build();
    const Vec3d n = glm::normalize(Vec3d(0.2, -0.9, 0.3));
    const View view = patchView(n, n, 1.2, 32); // from a distance of 2.2
    const Estimate on = measure(traced, view, optionsWith(IntegratorKind::Path, true), 16);
    const Estimate off = measure(traced, view, optionsWith(IntegratorKind::Path, false), 16);
    CAPTURE(on.mean(), on.standardError(), off.mean(), off.standardError());
    CHECK(on.agrees(0.8, 1e-6));
    CHECK(off.mean() < 0.799);
}

TEST_CASE("stability 53: flat facets, hollow sides, glass and averaged edges stay as they are",
          "[stability]")
{
    const View outside = perspectiveView({-0.8, -4, 1}, {0, 0, 0}, {0, 0, 1}, 32.0, kSmall, kSmall);
    const View inside =
        perspectiveView({0, 0, 0}, {0.6, 0.5, -0.4}, {0, 0, 1}, 70.0, kSmall, kSmall);
    const auto box = [](bool averaged)
    {
        auto mesh = boxMesh(Vec3(-0.7f), Vec3(0.7f));
        std::vector<Vec3> positions, normals;
        std::vector<UVec3> triangles;
        for (const UVec3& t : mesh->triangles)
        {
            const Vec3 p[3] = {mesh->positions[t.x], mesh->positions[t.y], mesh->positions[t.z]};
            const auto first = static_cast<uint32_t>(positions.size());
            triangles.push_back({first, first + 1, first + 2});
            for (const Vec3& q : p)
            {
                positions.push_back(q);
                normals.push_back(
                    glm::normalize(averaged ? q : glm::cross(p[1] - p[0], p[2] - p[0])));
            }
        }
        mesh = newMesh(positions, triangles);
        mesh->normals = std::move(normals);
        return mesh;
    };
    const struct
    {
        const char* name;
        std::shared_ptr<Mesh> mesh;
        Material material;
        View view;
        bool changes;
    } cases[] = {
        {"no normals", sphereMesh(Vec3(0.0f), 1.0f, 6), plastic(), outside, false},
        {"normals of the facets", box(false), plastic(), outside, false},
        {"averaged edges", box(true), plastic(), outside, false},
        {"hollow", smoothSphere(6), plastic(), inside, false},
        {"glass", smoothSphere(6), glass(1.5f, 0.3f), outside, false},
        {"smooth", smoothSphere(6), plastic(), outside, true},
    };
    for (const auto& c : cases)
    {
        for (const IntegratorKind kind : {IntegratorKind::Whitted, IntegratorKind::Path})
        {
            SceneBuilder builder;
            builder.add(c.mesh, c.material);
            builder.add(quadMesh({-3, -3, -1.3f}, {6, 0, 0}, {0, 6, 0}), lambert(Vec3(0.5f)));
            builder.addQuadLight({0.6f, -1.2f, 1.6f}, {0, 1.6f, 0}, {1.6f, 0, -0.8f}, Vec3(4.0f));
            builder.addQuadLight({-0.1f, -0.1f, 0.2f}, {0, 0.2f, 0}, {0.2f, 0, 0}, Vec3(4.0f),
                                 true);
            builder.addLight(sun({-0.9f, 0.2f, 0.35f}));
            const auto traced = builder.build();
            const Picture on = render(traced, c.view, optionsWith(kind, true), 4);
            const Picture off = render(traced, c.view, optionsWith(kind, false), 4);
            CAPTURE(c.name, int(kind));
            CHECK(on.mean().y > 0.01f);
            CHECK((on.rgba != off.rgba) == c.changes);
        }
    }
}

TEST_CASE("stability 53: light reaches no side that looks away from it, nor through the body",
          "[stability]")
{
    // The sphere is seen from behind: only light that the shading normals see may be visible.
    for (const Material& material : {lambert(Vec3(1.0f)), fixedFunctionWhite()})
    {
        for (const IntegratorKind kind : {IntegratorKind::Whitted, IntegratorKind::Path})
        {
            SceneBuilder builder;
            builder.add(smoothSphere(6), material);
            builder.addLight(sun({0, 1, 0}));
            const Picture picture =
                render(builder.build(), patchView(Vec3d(0.0), {0, 1, 0}, 2.0, 64),
                       optionsWith(kind, true), 4);
            CAPTURE(int(material.model), int(kind));
            CHECK(picture.mean() == Vec3(0.0f));
        }
    }
}

TEST_CASE("stability 53: depths are those of the facets", "[stability]")
{
    SceneBuilder builder;
    builder.add(smoothSphere(6), lambert(Vec3(0.5f)));
    builder.add(quadMesh({-3, -3, -1.3f}, {6, 0, 0}, {0, 6, 0}), lambert(Vec3(0.5f)));
    const auto traced = builder.build();
    const auto depthsWith = [&traced](bool correction, IntegratorKind kind)
    {
        RenderSession session(std::make_shared<Workers>(0));
        session.setScene(traced);
        session.setView(perspectiveView({-0.8, -4, 1}, {0, 0, 0}, {0, 0, 1}, 32.0, kSmall, kSmall));
        session.setOptions(optionsWith(kind, correction));
        StopRule rule;
        rule.passes = 1;
        session.render(rule);
        return session.resolveChannel(Channel::Depth);
    };
    for (const IntegratorKind kind : {IntegratorKind::Whitted, IntegratorKind::Path})
        CHECK(depthsWith(true, kind) == depthsWith(false, kind));
}
