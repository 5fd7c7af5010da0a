// SpecularTest.cpp - microfacets, glass and mirrors at the ends of their ranges. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/ExactFresnel.h"
#include "tests/integrators/Measure.h"

#include "osgRayTrace/shading/Fresnel.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns the squared error over the squared reference, as the mean over pixels, like relMSE with
/// an epsilon of 0.01.
double relativeSquaredError(const Picture& picture, const Picture& reference)
{
    double sum = 0.0;
    for (int i = 0; i < picture.width * picture.height; ++i)
    {
        const double x = picture.at(i % picture.width, i / picture.width).y;
        const double r = reference.at(i % picture.width, i / picture.width).y;
        sum += (x - r) * (x - r) / (r * r + 0.01);
    }
    return sum / (picture.width * picture.height);
}

float largestOf(const Picture& picture)
{
    float largest = 0.0f;
    for (int i = 0; i < picture.width * picture.height; ++i)
        largest = std::max(largest, picture.at(i % picture.width, i / picture.width).y);
    return largest;
}

Material metal(float alpha)
{
    Material material = mirror(Vec3(1.0f));
    material.roughness = std::sqrt(alpha);
    return material;
}

/// Returns a mirror floor below one lamp of radiance 1000 and two large dim lamps. If sampled is
/// true, the lamps are in the light table.
std::shared_ptr<const TracedScene> floorBelowLamps(float alpha, bool sampled)
{
    SceneBuilder builder;
    builder.add(quadMesh({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), metal(alpha));
    const auto add = [&](Vec3 corner, Vec3 u, Vec3 v, float radiance)
    {
        if (sampled)
            builder.addQuadLight(corner, u, v, Vec3(radiance), true);
        else
            builder.add(quadMesh(corner, u, v), lamp(Vec3(radiance)));
    };
    add({-1, 0, 2}, {0, 1, 0}, {1, 0, 0}, 1000.0f);
    add({-9, 4, 0.1f}, {18, 0, 0}, {0, 0, 1.9f}, 0.5f);
    add({-9, 4, 2}, {18, 0, 0}, {0, 0, 6}, 1.0f);
    return builder.build();
}

View floorView()
{
    return perspectiveView({0, -3, 1.5}, {0, -0.6, -1}, {0, 0, 1}, 60.0, 32, 32);
}

/// Returns count panes of glass of thickness 0.1, which are 0.1 apart, above a wide lamp of
/// radiance 1.
std::shared_ptr<const TracedScene> panes(int count)
{
    SceneBuilder builder;
    constexpr float kWide = 1e4f;
    builder.add(quadMesh({-kWide, -kWide, -1}, {2 * kWide, 0, 0}, {0, 2 * kWide, 0}),
                lamp(Vec3(1.0f)));
    for (int i = 0; i < count; ++i)
        builder.add(boxMesh({-kWide, -kWide, 0.2f * static_cast<float>(i)},
                            {kWide, kWide, 0.2f * static_cast<float>(i) + 0.1f}),
                    glass(1.5f));
    return builder.build();
}

View aboveThePanes(int count)
{
    return patchView({0, 0, 0.2 * count}, {0, 0, 1}, 0.05, 16);
}

} // namespace

TEST_CASE("stability 31: roughness towards 0 tends to the mirror image", "[stability][statistics]")
{
    const auto pictureOf = [](float alpha, bool sampled, int passes)
    {
        const Picture picture = render(floorBelowLamps(alpha, sampled), floorView(),
                                       optionsOf(IntegratorKind::Path, 1), passes);
        CHECK(picture.progress.droppedSamples == 0);
        return picture;
    };
    for (const bool sampled : {false, true})
    {
        const Picture mirrored = pictureOf(0.0f, sampled, 64);
        for (const float alpha : {1e-10f, 1e-5f, 1e-4f, 9.9e-4f})
        {
            CAPTURE(sampled, alpha);
            CHECK(relativeSquaredError(pictureOf(alpha, sampled, 64), mirrored) <= 1e-4);
        }
        // Beyond the width that counts as smooth there is no jump, but a blur, whose noise is at
        // the lamps' edges.
        double previous = 0.0;
        for (const float alpha : {1.01e-3f, 1e-2f, 1e-1f})
        {
            const double error = relativeSquaredError(pictureOf(alpha, sampled, 256), mirrored);
            CAPTURE(sampled, alpha, error, previous);
            CHECK(error > previous);
            previous = error;
        }
    }
}

TEST_CASE("stability 31: no single sample of a metal is brighter than what lights it",
          "[stability]")
{
    // Both estimators are weighted by the power heuristic. Each is at most 1 by itself if f <=
    // pdfW, so a sample of both is below 2 times the brightest lamp. A firefly would be orders of
    // magnitude brighter.
    for (const float alpha : {0.0f, 1.01e-3f, 2e-3f, 1e-2f, 0.1f, 0.5f, 1.0f})
    {
        float largest = 0.0f;
        double sum = 0.0;
        for (uint32_t seed = 0; seed < 64; ++seed)
        {
            const Picture picture = render(floorBelowLamps(alpha, true), floorView(),
                                           optionsOf(IntegratorKind::Path, 1, seed), 1);
            CHECK(picture.progress.droppedSamples == 0);
            largest = std::max(largest, largestOf(picture));
            sum += picture.mean().y;
        }
        CAPTURE(alpha, largest, sum / 64);
        CHECK(largest < 2000.0f);
        CHECK(sum / 64 > 1.0);
    }
}

TEST_CASE("stability 32: rough metal in a white room", "[stability][statistics]")
{
    // The table is that of single scattering, seen head-on: chance hits and light samples must both
    // give it.
    const struct
    {
        float alpha;
        double albedo, rounding;
    } table[] = {{1.0f, 0.30685282, 0.0},
                 {0.5f, 0.688, 5e-4},
                 {0.3f, 0.878, 5e-4},
                 {0.1f, 0.988, 5e-4},
                 {0.01f, 0.9999, 5e-5}};
    for (const auto& row : table)
    {
        for (const bool sampled : {false, true})
        {
            SceneBuilder builder;
            builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), metal(row.alpha));
            const auto room = boxMesh(Vec3(-3.0f), Vec3(3.0f));
            if (sampled)
                builder.addEmissive(room, lamp(Vec3(1.0f)));
            else
                builder.add(room, lamp(Vec3(1.0f)));
            const Estimate radiance =
                measure(builder.build(), patchView({0, 0, 0}, {0, 0, 1}, 0.1, 16),
                        optionsOf(IntegratorKind::Path, 1), 64);
            CAPTURE(row.alpha, sampled, radiance.mean(), radiance.standardError());
            CHECK(radiance.agrees(row.albedo, row.rounding + 1e-5));
            CHECK(radiance.standardError() < 5e-3);
        }
    }
}

TEST_CASE("stability 33: a body of index 1, or nearly 1, is invisible", "[stability]")
{
    // The room has six walls of different radiance, and every ray has to go straight on. Only
    // pixels whose ray meets an edge of the room may differ, because the way through the body moves
    // the ray by error bounds.
    const auto room = [](const Material* material, bool box)
    {
        SceneBuilder builder;
        const Vec3 low(-2.0f);
        for (int axis = 0; axis < 3; ++axis)
        {
            Vec3 u(0.0f), v(0.0f), far(0.0f);
            u[(axis + 1) % 3] = 4.0f;
            v[(axis + 2) % 3] = 4.0f;
            far[axis] = 4.0f;
            const auto shade = static_cast<float>(axis);
            builder.add(quadMesh(low, u, v), lamp(Vec3(1.0f + shade)));
            builder.add(quadMesh(low + far, v, u), lamp(Vec3(4.0f + shade)));
        }
        auto ball = sphereMesh(Vec3(0.0f), 0.6f, 16);
        ball->normals = std::vector<Vec3>(ball->positions.begin(), ball->positions.end());
        if (material)
            builder.add(box ? boxMesh({-0.7f, -0.6f, -0.5f}, {0.5f, 0.6f, 0.7f}) : ball, *material);
        return builder.build();
    };
    const View view = perspectiveView({0.9, -1.4, 0.8}, {0, 0, 0}, {0, 0, 1}, 60.0, 64, 64);
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
    {
        const Picture empty = render(room(nullptr, false), view, optionsOf(kind), 1);
        CHECK(largestOf(empty) > 2.0f);
        for (const float ior : {1.0f, 1.0f + 1.2e-7f, 1.0f - 1.2e-7f})
        {
            for (const float roughness : {0.0f, 0.3f})
            {
                for (const bool box : {false, true})
                {
                    const Material material = glass(ior, roughness);
                    const Picture picture = render(room(&material, box), view, optionsOf(kind), 1);
                    CHECK(picture.progress.droppedSamples == 0);
                    int different = 0;
                    for (int i = 0; i < 64 * 64; ++i)
                    {
                        const float there = empty.at(i % 64, i / 64).y;
                        different += std::abs(picture.at(i % 64, i / 64).y - there) > 1e-6f * there;
                    }
                    CAPTURE(int(kind), ior, roughness, box);
                    CHECK(different <= 2);
                }
            }
        }
    }
}

TEST_CASE("stability 33: a body of index 1 casts no shadow and no caustic", "[stability]")
{
    // The body is not traced at all, so the pictures are equal bit by bit; a body with a tint is
    // traced.
    const auto room = [](const Material* material, LightKind lamps)
    {
        SceneBuilder builder;
        builder.add(quadMesh({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}), lambert(Vec3(0.5f)));
        if (lamps == LightKind::Parallelogram)
            builder.addQuadLight({-0.5f, -0.5f, 3}, {0, 1, 0}, {1, 0, 0}, Vec3(5.0f));
        else if (lamps == LightKind::Mesh)
            builder.addEmissive(boxMesh({-0.5f, -0.5f, 3}, {0.5f, 0.5f, 3.2f}), lamp(Vec3(5.0f)));
        else
            builder.addLight(pointLight(Vec3(0, 0, 3), Vec3(9.0f)));
        if (material) builder.add(sphereMesh({0, 0, 1}, 0.6f, 16), *material);
        return builder.build();
    };
    const View view = perspectiveView({0, -4, 2}, {0, 0, 0.5}, {0, 0, 1}, 50.0, 48, 48);
    const auto differing = [&](const Material& material, LightKind lamps, IntegratorKind kind)
    {
        const RenderOptions options = optionsOf(kind, 4);
        const Picture empty = render(room(nullptr, lamps), view, options, 2);
        CHECK(largestOf(empty) > 0.01f);
        const Picture picture = render(room(&material, lamps), view, options, 2);
        CHECK(picture.progress.droppedSamples == 0);
        int different = 0;
        for (std::size_t i = 0; i < picture.rgba.size(); ++i)
            different += picture.rgba[i] != empty.rgba[i];
        return different;
    };
    for (const LightKind lamps : {LightKind::Point, LightKind::Parallelogram, LightKind::Mesh})
    {
        for (const IntegratorKind kind :
             {IntegratorKind::Whitted, IntegratorKind::Path, IntegratorKind::PhotonCaustics,
              IntegratorKind::Ppm, IntegratorKind::Sppm})
        {
            CAPTURE(int(lamps), int(kind));
            for (const float ior : {1.0f, 1.0f + 1.2e-7f, 1.0f - 1.2e-7f})
                for (const float roughness : {0.0f, 0.3f})
                    CHECK(differing(glass(ior, roughness), lamps, kind) == 0);
            Material tinted = glass(1.0f);
            tinted.baseColor = Vec3(0.5f, 1.0f, 1.0f);
            CHECK(differing(tinted, lamps, kind) > 0);
        }
    }
}

TEST_CASE("stability 34: total reflection begins within 1e-5 degrees", "[stability]")
{
    // The reference is the formula in double, for the cosines and the index as they are in float:
    // these are 2e-6 degrees apart.
    const float eta = 1.0f / 1.5f;
    const double critical = std::asin(double(eta)) * 180.0 / M_PI;
    CHECK(critical == Approx(41.810315).margin(2e-5));
    for (const double away : {1e-5, 2e-5, 5e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0})
    {
        const auto above = static_cast<float>(std::cos((critical + away) * M_PI / 180.0));
        const auto below = static_cast<float>(std::cos((critical - away) * M_PI / 180.0));
        CAPTURE(away);
        CHECK(fresnelDielectric(above, eta) == 1.0f);
        CHECK(fresnelDielectric(below, eta) < 1.0f);
        CHECK(std::abs(fresnelDielectric(below, eta) -
                       exactReflectance(double(below), double(eta))) < 1e-4);
    }
}

TEST_CASE("stability 35: grazing incidence on every surface", "[stability][statistics]")
{
    CHECK(fresnelDielectric(static_cast<float>(std::sin(1e-4 * M_PI / 180.0)), 1.5f) ==
          Approx(1.0).margin(1e-3));
    // The camera is 1e-4 degrees above the plane of a floor in a white room.
    const double rise = 1e-4 * M_PI / 180.0;
    const View view = perspectiveView({-40, 0, 40 * rise}, {0, 0, 0}, {0, 0, 1}, 1e-9, 8, 8);
    Material plastic = lambert(Vec3(0.8f));
    plastic.ior = 1.5f;
    plastic.roughness = 0.0f;
    const struct
    {
        const char* name;
        Material material;
        double low, high;
    } cases[] = {
        {"smooth glass", glass(1.5f), 0.999, 1.0},   {"rough glass", glass(1.5f, 0.5f), 0.0, 1.01},
        {"mirror", metal(0.0f), 0.999, 1.0},         {"rough metal", metal(0.25f), 0.5, 1.0},
        {"smooth plastic", plastic, 0.999, 1.0},     {"lambert", lambert(Vec3(0.8f)), 0.8, 0.8},
        {"fully rough metal", metal(1.0f), 0.0, 1.0}};
    for (const auto& c : cases)
    {
        SceneBuilder builder;
        builder.addEmissive(boxMesh({-99, -99, -99}, {99, 99, 99}), lamp(Vec3(1.0f)));
        builder.add(boxMesh({-1, -1, -2}, {1, 1, 0}), c.material);
        const Estimate radiance =
            measure(builder.build(), view, optionsOf(IntegratorKind::Path, 100), 64);
        CAPTURE(c.name, radiance.mean(), radiance.standardError());
        const double margin = 1e-3 + 4.0 * radiance.standardError();
        CHECK(radiance.mean() > c.low - margin);
        CHECK(radiance.mean() < c.high + margin);
        CHECK(radiance.standardError() < 0.02);
    }
}

TEST_CASE("stability 36: stacks of clear panes", "[stability][statistics]")
{
    // Together, 2 n surfaces of reflectance R = 0.04 pass (1 - R) / (1 + (2 n - 1) R), with all
    // bounces between them.
    for (const int count : {1, 8, 32})
    {
        const double expected = 0.96 / (1.0 + (2 * count - 1) * 0.04);
        const Estimate radiance =
            measure(panes(count), aboveThePanes(count), optionsOf(IntegratorKind::Path, 4096), 64);
        CAPTURE(count, expected, radiance.mean(), radiance.standardError());
        CHECK(radiance.agrees(expected, 1e-5));
        CHECK(radiance.standardError() < 5e-3);
    }
}

TEST_CASE("stability 36: clear panes with Whitted's rays", "[stability]")
{
    // Rays below 1/1024 that are outside of glass end: in one pane this is the fourth bounce within
    // it, of 2.4e-6 of the light. In stacks these rays become many.
    const auto lightThrough = [](int count)
    {
        const RenderOptions options = optionsOf(IntegratorKind::Whitted, 256);
        return render(panes(count), aboveThePanes(count), options, 1).mean().y;
    };
    CHECK(lightThrough(1) == Approx(0.96 / 1.04).margin(1e-5));
    CHECK(lightThrough(2) == Approx(0.96 / 1.12).margin(1e-4));
}

TEST_CASE("stability 36: a stack deeper than maxBounces shows nothing behind it", "[stability]")
{
    // Each pane costs two of maxBounces, so the default of 8 sees through four panes.
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
    {
        CAPTURE(int(kind));
        CHECK(render(panes(4), aboveThePanes(4), optionsOf(kind, 8), 16).mean().y > 0.5f);
        CHECK(render(panes(5), aboveThePanes(5), optionsOf(kind, 8), 16).mean().y == 0.0f);
    }
}

TEST_CASE("stability 36: no sample through clear glass is brighter than what is behind it",
          "[stability]")
{
    // The throughput is 1/2.25 within the panes: roulette must not take that for a loss, or the
    // paths that survive it would arrive with 2.25. Camera paths go both ways at the first
    // interface, and what they reflect is black: the brightest samples have its transmittance,
    // 0.96.
    float largest = 0.0f;
    for (uint32_t seed = 0; seed < 64; ++seed)
        largest =
            std::max(largest, largestOf(render(panes(8), aboveThePanes(8),
                                               optionsOf(IntegratorKind::Path, 4096, seed), 1)));
    CHECK(largest == Approx(0.96).epsilon(1e-5));
}
