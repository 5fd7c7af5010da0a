// LensTest.cpp - depth of field compared with the geometry of a thin lens. Layer: tests.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/image/ResolvedImage.h"
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kPixels = 40;
constexpr float kHalfLamp = 0.01f;
constexpr double kHalfView = 0.1; ///< tangent of half the angle of view

/// Returns a view of the origin along -z.
View sight()
{
    const double fovyDegrees = glm::degrees(2.0 * std::atan(kHalfView));
    return perspectiveView({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, fovyDegrees, kPixels, kPixels);
}

/// Returns a small lamp in front of the eye, and darkness behind it.
std::shared_ptr<const TracedScene> lampAt(float z)
{
    SceneBuilder builder;
    builder.add(quadMesh({-kHalfLamp, -kHalfLamp, z}, {2 * kHalfLamp, 0, 0}, {0, 2 * kHalfLamp, 0}),
                lamp(Vec3(7.0f)));
    builder.add(quadMesh({-9, -9, -8}, {18, 0, 0}, {0, 18, 0}), lamp(Vec3(0.0f)));
    return builder.build();
}

RenderOptions lensOptions(IntegratorKind kind, float focus)
{
    RenderOptions options = optionsOf(kind, 1);
    options.aperture = 0.4f;
    options.focus = focus;
    return options;
}

/// The light of a picture, and how far it is spread around the middle [tangents].
struct Spread
{
    double sum = 0.0, secondMoment = 0.0;
};

Spread spreadOf(const Picture& picture)
{
    constexpr double kWidth = 2.0 * kHalfView / kPixels;
    Spread spread;
    double moments = 0.0;
    for (int y = 0; y < kPixels; ++y)
        for (int x = 0; x < kPixels; ++x)
        {
            const double dx = (x + 0.5) * kWidth - kHalfView, dy = (y + 0.5) * kWidth - kHalfView;
            const double light = double(picture.at(x, y).y) * kWidth * kWidth;
            spread.sum += light;
            moments += light * (dx * dx + dy * dy);
        }
    spread.secondMoment = moments / spread.sum;
    return spread;
}

} // namespace

TEST_CASE("lens: a lamp out of focus is an even disc of a thin lens's size", "[integrators]")
{
    // From the point L of the lens, a lamp at the distance d is where L * (1/f - 1/d) would be.
    const auto traced = lampAt(-2.0f);
    const double radius = 0.2 * (1.0 / 2.0 - 1.0 / 4.0), half = double(kHalfLamp) / 2.0;
    const double pixel = 2.0 * kHalfView / kPixels;
    // The moments of a disc, of the lamp and, of points in them, of pixels.
    const double expected = radius * radius / 2.0 + 2.0 * half * half / 3.0 - pixel * pixel / 6.0;
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
    {
        CAPTURE(int(kind));
        Estimate sums, moments;
        for (uint32_t seed = 0; seed < 16; ++seed)
        {
            RenderOptions options = lensOptions(kind, 4.0f);
            options.seed = seed;
            const Spread spread = spreadOf(render(traced, sight(), options, 64));
            sums.add(spread.sum);
            moments.add(spread.secondMoment);
        }
        CHECK(sums.agrees(7.0 * 4.0 * half * half));
        CHECK(moments.agrees(expected, pixel * pixel / 2.0));
        CHECK(moments.standardError() < 0.05 * expected);
    }
}

TEST_CASE("lens: what is in focus is as sharp as a pinhole shows it", "[integrators]")
{
    const Spread lens =
        spreadOf(render(lampAt(-2.0f), sight(), lensOptions(IntegratorKind::Path, 2.0f), 64));
    RenderOptions pinhole = lensOptions(IntegratorKind::Path, 2.0f);
    pinhole.aperture = 0.0f;
    const Spread sharp = spreadOf(render(lampAt(-2.0f), sight(), pinhole, 64));
    CHECK(lens.sum == Approx(sharp.sum).epsilon(1e-4));
    CHECK(lens.secondMoment == Approx(sharp.secondMoment).epsilon(1e-3));
}

TEST_CASE("lens: without a distance what is straight ahead is in focus", "[integrators]")
{
    const auto traced = lampAt(-2.0f);
    const RenderOptions at = lensOptions(IntegratorKind::Path, 2.0f);
    const Picture found = render(traced, sight(), lensOptions(IntegratorKind::Path, 0.0f), 4);
    CHECK(found.rgba == render(traced, sight(), at, 4).rgba);
    CHECK(found.rgba != render(traced, sight(), lensOptions(IntegratorKind::Path, 3.0f), 4).rgba);

    SceneBuilder empty; // nothing ahead: a pinhole
    empty.add(quadMesh({-9, -9, 8}, {18, 0, 0}, {0, 18, 0}), lamp(Vec3(1.0f)));
    CHECK(render(empty.build(), sight(), lensOptions(IntegratorKind::Path, 0.0f), 1)
              .progress.status.ok());
}

TEST_CASE("lens: depth slices of a picture have one focus", "[integrators]")
{
    // The nearer slice has the lamp that is straight ahead, the other one a lamp beside it.
    SceneBuilder builder;
    builder.add(
        quadMesh({-kHalfLamp, -kHalfLamp, -2}, {2 * kHalfLamp, 0, 0}, {0, 2 * kHalfLamp, 0}),
        lamp(Vec3(7.0f)));
    builder.add(quadMesh({0.1f, 0.1f, -4}, {0.1f, 0, 0}, {0, 0.1f, 0}), lamp(Vec3(7.0f)));
    const auto traced = builder.build();
    for (const auto& [near, far] : {std::pair(0.1, 3.0), std::pair(3.0, 100.0)})
    {
        CAPTURE(near);
        View slice = sight();
        slice.clipFromView[2][2] = -(far + near) / (far - near);
        slice.clipFromView[3][2] = -2.0 * far * near / (far - near);
        const auto pictureAt = [&](float focus)
        { return render(traced, slice, lensOptions(IntegratorKind::Path, focus), 4).rgba; };
        CHECK((pictureAt(0.0f) == pictureAt(2.0f)));
        CHECK((pictureAt(0.0f) != pictureAt(4.0f)));
    }
}

TEST_CASE("lens: depths and first hits are those of a pinhole", "[integrators]")
{
    const auto traced = lampAt(-2.0f);
    const auto depthsOf = [&](IntegratorKind kind, float aperture)
    {
        RenderSession session(std::make_shared<Workers>(2));
        RenderOptions options = lensOptions(kind, 4.0f);
        options.aperture = aperture;
        options.centredFirstPass = true;
        session.setScene(traced);
        session.setView(sight());
        session.setOptions(options);
        StopRule rule;
        rule.passes = 2;
        REQUIRE(session.render(rule).status.ok());
        std::vector<float> values = session.resolveChannel(Channel::Depth);
        for (const SurfaceSample& sample : session.surfaceSamples())
            values.push_back(sample.distance);
        return values;
    };
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
        CHECK(depthsOf(kind, 0.4f) == depthsOf(kind, 0.0f));
}

TEST_CASE("lens: equal pictures for any number of threads, with photons as well", "[integrators]")
{
    SceneBuilder builder = cornellBox();
    builder.add(sphereMesh(Vec3(400, 120, 120), 60.0f, 24), glass(1.5f));
    const auto traced = builder.build();
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::PhotonCaustics})
    {
        RenderOptions options = optionsOf(kind);
        options.aperture = 50.0f;
        options.photons = 5000;
        const Picture one = render(traced, cornellView(40, 30), options, 3, 1);
        CHECK(one.progress.droppedSamples == 0);
        CHECK(render(traced, cornellView(40, 30), options, 3, 3).rgba == one.rgba);
        options.aperture = 0.0f;
        CHECK(render(traced, cornellView(40, 30), options, 3, 3).rgba != one.rgba);
    }
}

TEST_CASE("lens: parallel views have none", "[integrators]")
{
    const auto traced = lampAt(-2.0f);
    const View parallel = patchView({0, 0, -3}, {0, 0, 1}, 0.5, kPixels);
    RenderOptions pinhole = lensOptions(IntegratorKind::Path, 4.0f);
    pinhole.aperture = 0.0f;
    CHECK(render(traced, parallel, lensOptions(IntegratorKind::Path, 4.0f), 2).rgba ==
          render(traced, parallel, pinhole, 2).rgba);
}
