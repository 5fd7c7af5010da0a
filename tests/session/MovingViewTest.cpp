// MovingViewTest.cpp - a view that moves carries its samples along, and nothing that is wrong.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/PhotonPasses.h"
#include "osgRayTrace/session/view/ViewTracer.h"

#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"

#include <cmath>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kWidth = 32, kHeight = 24;

View viewAt(double t, int width = kWidth, int height = kHeight)
{
    return perspectiveView({278.0 + 6.0 * t, 273.0 + 3.0 * t, -800.0}, {278.0, 273.0, 279.0},
                           {0, 1, 0}, 40.0, width, height);
}

/// Returns a view of the blocks and the floor only.
View lowViewAt(double t)
{
    return perspectiveView({278.0 + 6.0 * t, 150.0 + 3.0 * t, -600.0}, {278.0, 150.0, 279.0},
                           {0, 1, 0}, 20.0, kWidth, kHeight);
}

/// Traces a view frame by frame, with one pass each.
struct Walker
{
    explicit Walker(std::shared_ptr<const TracedScene> scene, bool reproject = true,
                    unsigned seed = 0, int threads = 1)
    {
        inputs.scene = std::move(scene);
        inputs.workers = std::make_shared<Workers>(threads);
        inputs.photons = std::make_shared<PhotonPasses>();
        inputs.options.integrator = IntegratorKind::Path;
        inputs.maxPasses = 1 << 20;
        inputs.reprojects = reproject;
        inputs.options.seed = seed;
    }

    /// Returns the radiance that is presented in the frame; rgba has its display values.
    std::vector<float> show(const View& view)
    {
        rgba.assign(
            4 * static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height), 0);
        std::vector<float> depth(rgba.size() / 4);
        tracer.trace(inputs, view, {}, rgba.data(), depth.data());
        if (tracer.needsResolve(inputs)) tracer.resolve(rgba.data(), depth.data());
        return tracer.radiance();
    }
    double share() const { return tracer.progress().stages.reprojectedShare; }

    ViewInputs inputs;
    ViewTracer tracer;
    std::vector<uint8_t> rgba;
};

/// Returns the picture of the first frame of a view without any history.
std::vector<float> fresh(const Walker& walker, const View& view)
{
    Walker other(walker.inputs.scene);
    const ViewInputs own = other.inputs;
    other.inputs = walker.inputs;
    other.inputs.workers = own.workers;
    other.inputs.photons = own.photons;
    return other.show(view);
}

std::vector<float> converged(const std::shared_ptr<const TracedScene>& scene, const View& view,
                             int passes)
{
    return render(scene, view, optionsOf(IntegratorKind::Path, 8, 77), passes).rgba;
}

/// Returns the mean squared error of RGB.
double squaredError(const std::vector<float>& picture, const std::vector<float>& reference)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < picture.size(); ++i)
        if (i % 4 != 3)
            sum += (double(picture[i]) - reference[i]) * (double(picture[i]) - reference[i]);
    return sum / (0.75 * double(picture.size()));
}

double meanOf(const std::vector<float>& picture)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < picture.size(); ++i)
        if (i % 4 != 3) sum += picture[i];
    return sum / (0.75 * double(picture.size()));
}

} // namespace

TEST_CASE("moving view: without reprojection, and at rest, nothing changes", "[session]")
{
    const auto scene = cornellBox().build();
    Walker with(scene), without(scene, false);
    for (int frame = 0; frame < 3; ++frame)
    {
        CHECK(with.show(viewAt(0)) == without.show(viewAt(0)));
        CHECK(with.rgba == without.rgba);
        CHECK(with.share() == 0.0);
    }
    for (int frame = 1; frame < 3; ++frame)
    {
        CHECK(without.show(viewAt(frame)) == fresh(without, viewAt(frame)));
        CHECK(without.share() == 0.0);
    }
}

TEST_CASE("moving view: the samples of earlier frames lower the error of a frame", "[session]")
{
    const auto scene = cornellBox().build();
    Walker with(scene), without(scene, false);
    for (int frame = 0; frame < 15; ++frame)
    {
        with.show(viewAt(frame));
        without.show(viewAt(frame));
    }
    const std::vector<float> reference = converged(scene, viewAt(15), 400);
    const std::vector<float> image = with.show(viewAt(15));
    const double plain = squaredError(without.show(viewAt(15)), reference),
                 error = squaredError(image, reference);
    INFO(plain << " to " << error);
    CHECK(with.share() > 0.9);
    CHECK(error < 0.3 * plain);

    // The display values are sRGB of the radiance, to rounding.
    for (std::size_t i = 0; i < image.size(); i += 4)
    {
        const double v = std::min(1.0, std::max(0.0, double(image[i])));
        const double display =
            255.0 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055);
        if (image[i + 3] < 1.0f) continue; // values are encoded before coverage scales them
        INFO(i << ": " << image[i] << " shown as " << int(with.rgba[i]));
        REQUIRE(std::abs(with.rgba[i] - display) < 0.52);
    }
}

TEST_CASE("moving view: at rest the history fades, and the image is the film's own", "[session]")
{
    const auto scene = cornellBox().build();
    Walker walker(scene);
    for (int frame = 0; frame < 12; ++frame)
        walker.show(lowViewAt(frame));
    const View rest = lowViewAt(11);
    const std::vector<float> reference = converged(scene, rest, 512);
    for (int passes = 2; passes <= 65; ++passes)
    {
        const std::vector<float> image = walker.show(rest);
        if (passes != 2 && passes != 4 && passes != 8 && passes != 16 && passes != 32 &&
            passes < 64)
            continue;
        const double error = squaredError(image, reference);
        const double plain = squaredError(
            render(scene, rest, optionsOf(IntegratorKind::Path), passes).rgba, reference);
        INFO(passes << " passes: " << plain << " to " << error);
        // Both errors vary by chance.
        CHECK(error < 1.3 * plain);
    }
    CHECK(walker.share() == 0.0);
    // From here on tracing is as fast as ever: display values are written while tiles are traced.
    std::vector<float> depth(kWidth * kHeight);
    CHECK(walker.tracer.trace(walker.inputs, rest, {}, walker.rgba.data(), depth.data()));
}

TEST_CASE("moving view: no change of the scene or the options leaves a trace of what was",
          "[session]")
{
    const auto scene = cornellBox().build();
    SceneBuilder brighter = cornellBox();
    for (Material& material : brighter.scene->materials)
        material.baseColor *= 0.7f;
    const auto other = brighter.build();
    const auto walked = [&]
    {
        auto walker = std::make_unique<Walker>(scene);
        for (int frame = 0; frame < 4; ++frame)
            walker->show(viewAt(frame));
        REQUIRE(walker->share() > 0.5);
        return walker;
    };
    const View next = viewAt(4);
    const auto check = [&](Walker& walker, const View& view)
    {
        CHECK(walker.show(view) == fresh(walker, view));
        CHECK(walker.share() == 0.0);
    };
    for (const View& view : {viewAt(3), next})
    {
        auto walker = walked();
        walker->inputs.scene = other;
        check(*walker, view);

        walker = walked();
        walker->inputs.options.maxBounces = 2;
        check(*walker, view);

        walker = walked();
        walker->inputs.options.integrator = IntegratorKind::Whitted;
        check(*walker, view);

        walker = walked();
        walker->inputs.workers = std::make_shared<Workers>(1);
        check(*walker, view);
    }

    // The history is dropped if reprojection is switched off, and begins anew if it is switched on
    // again.
    auto walker = walked();
    walker->inputs.reprojects = false;
    check(*walker, next);
    walker->inputs.reprojects = true;
    walker->show(next);
    CHECK(walker->share() == 0.0);

    // The view is cut to surfaces that nothing has seen before.
    walker = walked();
    walker->show(
        perspectiveView({278, 273, 200}, {278, 273, -900}, {0, 1, 0}, 40.0, kWidth, kHeight));
    CHECK(walker->share() == 0.0);

    // A view that cannot be traced leaves the history as it is.
    walker = walked();
    View broken = next;
    broken.clipFromView = Mat4d(0.0);
    walker->show(broken);
    walker->show(next);
    CHECK(walker->share() > 0.5);
}

TEST_CASE("moving view: a view of another size takes along what it can", "[session]")
{
    const auto scene = cornellBox().build();
    // The sizes have more pixels, in which each sample counts for less, then fewer, then nearly as
    // many as at first.
    const int sizes[][2] = {
        {2 * kWidth, 2 * kHeight}, {kWidth, kHeight}, {kWidth + 5, kHeight - 3}};
    Walker walker(scene), plain(scene, false);
    for (int frame = 0; frame < 8; ++frame)
        walker.show(lowViewAt(frame));
    for (const auto& size : sizes)
    {
        View view = lowViewAt(8);
        view.width = size[0];
        view.height = size[1];
        const std::vector<float> reference = converged(scene, view, 256);
        const double error = squaredError(walker.show(view), reference);
        const double without = squaredError(plain.show(view), reference);
        INFO(view.width << " x " << view.height << ": " << without << " to " << error);
        CHECK(walker.share() > 0.9);
        CHECK(error < 0.5 * without);
    }
    walker.show(viewAt(8, 1, 1)); // any picture will do
    CHECK(walker.show(lowViewAt(8)).size() == 4u * kWidth * kHeight);
}

TEST_CASE("moving view: lights and textures that follow the eye leave no history", "[session]")
{
    SceneBuilder lit = cornellBox();
    Light head = pointLight({0, 0, 0}, Vec3(1e5f));
    head.eyeSpace = true;
    lit.addLight(head);
    Walker walker(lit.build());
    for (int frame = 0; frame < 3; ++frame)
        CHECK(walker.show(viewAt(frame)) == fresh(walker, viewAt(frame)));

    SceneBuilder mapped = cornellBox();
    CHECK_FALSE(viewDependence(*mapped.scene).everywhere);
    CHECK_FALSE(viewDependence(*mapped.scene).axes);
    mapped.scene->materials.back().mapping.coordinates = TextureCoordinates::SphereMap;
    CHECK(viewDependence(*mapped.scene).everywhere);

    SceneBuilder shiny = cornellBox();
    Material& material = shiny.scene->materials.back();
    material.model = MaterialModel::FixedFunction;
    material.specular = Vec3(0.5f);
    CHECK(viewDependence(*shiny.scene).axes);
    material.localViewer = true;
    CHECK_FALSE(viewDependence(*shiny.scene).axes);
}

TEST_CASE("moving view: the mean of a diffuse scene stays what it is", "[session][statistics]")
{
    // No lamp is visible, because its edge would hide all else. There are sixteen walks of twelve
    // frames; false alarms are those of Estimate::agrees, 1e-3 each. Pixels on edges mix surfaces
    // that move apart: their four samples may bring 2 % of the picture's mean.
    const auto scene = cornellBox().build();
    const View last = lowViewAt(0.7 * 11);
    RenderSession session(std::make_shared<Workers>(1));
    session.setScene(scene);
    session.setView(last);
    session.setOptions(optionsOf(IntegratorKind::Path, 8, 77));
    session.setKeepsSurfaces(true);
    StopRule rule;
    rule.passes = 1000;
    session.render(rule);
    const SurfaceMap& map = session.surfaces();
    REQUIRE(map.isOf(last));
    const auto smoothMean = [&](const std::vector<float>& picture)
    {
        double sum = 0.0, pixels = 0.0;
        for (std::size_t i = 0; i < map.smooth.size(); ++i)
        {
            if (!map.smooth[i]) continue;
            sum += picture[4 * i] + picture[4 * i + 1] + picture[4 * i + 2];
            pixels += 3.0;
        }
        return sum / pixels;
    };
    Estimate mean, smooth;
    for (unsigned seed = 0; seed < 16; ++seed)
    {
        Walker walker(scene, true, seed);
        for (int frame = 0; frame < 11; ++frame)
            walker.show(lowViewAt(0.7 * frame));
        const std::vector<float> picture = walker.show(last);
        mean.add(meanOf(picture));
        smooth.add(smoothMean(picture));
    }
    const std::vector<float> reference = session.resolveRadiance();
    const double expected = meanOf(reference), expectedSmooth = smoothMean(reference);
    INFO(mean.mean() << " +- " << mean.standardError() << ", expected " << expected << "; smooth "
                     << smooth.mean() << " +- " << smooth.standardError() << ", expected "
                     << expectedSmooth);
    CHECK(smooth.standardError() < 0.01 * expectedSmooth);
    CHECK(smooth.agrees(expectedSmooth));
    CHECK(mean.agrees(expected, 0.02 * expected));
}

TEST_CASE("moving view: errors are those of film and history together", "[session]")
{
    const auto scene = cornellBox().build();
    const auto workers = std::make_shared<Workers>(1);
    for (const int passes : {1, 6})
    {
        RenderSession session(workers);
        session.setScene(scene);
        session.setOptions(optionsOf(IntegratorKind::Path));
        session.setKeepsSurfaces(true);
        ViewHistory history;
        StopRule rule;
        rule.newPasses = passes;
        for (int frame = 0; frame < 5; ++frame)
        {
            if (frame > 0) history.leave(session, lowViewAt(frame - 1), *workers);
            session.setView(lowViewAt(frame));
            session.setSequence(static_cast<uint32_t>(frame));
            session.render(rule);
            history.enter(session, lowViewAt(frame), {}, *workers);
        }
        ResolvedImage image = session.resolvedImage();
        history.blend(session, image, *workers);
        const std::vector<float> reference = converged(scene, lowViewAt(4), 512);
        double estimated = 0.0;
        for (const float error : image.error)
        {
            REQUIRE(error >= 0.0f);
            estimated += double(error) * error / double(image.error.size());
        }
        const double actual = squaredError(image.radiance, reference);
        INFO(passes << " passes a frame: " << estimated << " estimated, " << actual << " actual");
        // Carried samples are means of neighbours' samples: they err less than as many samples of
        // one pixel.
        CHECK(estimated < 4.0 * actual);
        CHECK(estimated > 0.7 * actual);
        if (passes != 1) continue;
        // Four frames of one sample each are dropped with the ninth pass, and not before.
        for (const int more : {7, 1})
        {
            rule.newPasses = more;
            session.render(rule);
            const ResolvedImage film = session.resolvedImage();
            ResolvedImage blended = film;
            history.blend(session, blended, *workers);
            CHECK((blended.radiance == film.radiance) == (more == 1));
        }
    }
}
