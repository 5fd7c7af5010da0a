// FreshSamplesTest.cpp - pixels with few samples get more, which are those of the image, and no
// more than there is time for.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/history/FreshSamples.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/session/view/ImageStages.h"

#include "tests/Catch.h"
#include "tests/Statistics.h"
#include "tests/session/KeptYard.h"

#include <algorithm>
#include <numeric>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr std::size_t kPixels = std::size_t(kWidth) * kHeight;

const auto kGoOn = [] { return false; };

/// Holds an image of one pass of the yard.
struct OnePass
{
    explicit OnePass(int threads = 1, unsigned seed = 0,
                     IntegratorKind integrator = IntegratorKind::Path, Yard yard = Yard(),
                     bool centred = false)
        : workers(std::make_shared<Workers>(threads)), session(workers)
    {
        session.setScene(traced(yard.at(0.0f)));
        session.setView(yardView());
        session.setCentred(centred);
        RenderOptions options = noisyOptions(seed);
        options.integrator = integrator;
        session.setOptions(options);
        StopRule rule;
        rule.passes = 1;
        session.render(rule);
    }

    /// Returns black pixels with so many samples each.
    static SampledImage black(float count)
    {
        return {kWidth, kHeight, std::vector<float>(4 * kPixels),
                std::vector<float>(kPixels, count)};
    }

    void addTo(SampledImage& image, float most = 64.0f)
    {
        addFreshSamples(session, most, kGoOn, *workers, image);
    }

    std::shared_ptr<Workers> workers;
    RenderSession session;
};

double sumOf(const std::vector<float>& values)
{
    return std::accumulate(values.begin(), values.end(), 0.0);
}

} // namespace

TEST_CASE("fresh samples: pixels with few samples get them, those with least first", "[session]")
{
    OnePass yard;
    SampledImage image = OnePass::black(20.0f);
    for (std::size_t i = 0; i < 100; ++i)
        image.count[i] = static_cast<float>(i % 10);
    yard.addTo(image);
    for (std::size_t i = 0; i < kPixels; ++i)
    {
        CAPTURE(i);
        const float before = i < 100 ? static_cast<float>(i % 10) : 20.0f;
        const float wanted = std::min(4.0f, std::max(0.0f, 8.0f - before));
        REQUIRE(image.count[i] == before + wanted);
        REQUIRE((brightness(image.radiance, i) > 0.0f) == (wanted > 0.0f));
    }

    // A quarter of a pass goes to the pixels that have none: four samples each would be too many.
    image = OnePass::black(2.0f);
    std::fill_n(image.count.begin(), kPixels / 10, 0.0f);
    yard.addTo(image);
    CHECK(sumOf(image.count) == 2.0 * 0.9 * kPixels + 2.0 * 0.1 * kPixels);
    CHECK(*std::min_element(image.count.begin(), image.count.end()) == 2.0f);
    CHECK(*std::max_element(image.count.begin(), image.count.end()) == 2.0f);

    // No pixel gets more than the most that it may keep.
    image = OnePass::black(20.0f);
    std::fill_n(image.count.begin(), 100, 1.5f);
    yard.addTo(image, 3.5f);
    CHECK(sumOf(image.count) == 20.0 * (kPixels - 100) + 2.5 * 100);

    // All of the image lacks samples: there is no time for any.
    image = OnePass::black(0.0f);
    yard.addTo(image);
    CHECK(sumOf(image.count) == 0.0);
}

TEST_CASE("fresh samples: they end when they are to, after the same number in all pixels",
          "[session]")
{
    OnePass yard;
    SampledImage image = OnePass::black(20.0f);
    for (std::size_t i = 0; i < kPixels; i += 41)
        image.count[i] = 0.0f;
    int calls = 0;
    addFreshSamples(
        yard.session, 64.0f, [&calls] { return ++calls > 20; }, *yard.workers, image);
    CHECK(calls == 21); // of 15 tiles with four samples each
    std::size_t ones = 0, twos = 0;
    for (std::size_t i = 0; i < kPixels; i += 41)
    {
        ones += image.count[i] == 1.0f;
        twos += image.count[i] == 2.0f;
    }
    CHECK(ones + twos == kPixels / 41 + 1);
    CHECK(twos > 0);
    CHECK(ones > twos);
}

TEST_CASE("fresh samples: equal bits for one and two threads", "[session]")
{
    SampledImage images[2];
    for (const int threads : {1, 2})
    {
        SampledImage& image = images[threads - 1];
        image = OnePass::black(20.0f);
        for (std::size_t i = 0; i < kPixels; i += 17)
            image.count[i] = static_cast<float>(i % 3);
        OnePass(threads).addTo(image);
    }
    CHECK(images[0].radiance == images[1].radiance);
    CHECK(images[0].count == images[1].count);
}

TEST_CASE("fresh samples: their mean is that of the image, and they are independent of it",
          "[session][statistics]")
{
    // Some pixels of each tile are wanted, so that the paths that pixels share are those of these
    // pixels. A false alarm has a probability of 1e-3, see Estimate::agrees.
    const std::vector<float> reference = fresh(Yard().at(0.0f), 77, 256);
    Estimate mean, product;
    for (unsigned seed = 0; seed < 32; ++seed)
    {
        OnePass yard(1, seed);
        SampledImage image = OnePass::black(20.0f);
        const std::vector<float> film = yard.session.resolveRadiance();
        for (std::size_t i = seed % 17; i < kPixels; i += 17)
            image.count[i] = 0.0f;
        yard.addTo(image);
        double sum = 0.0, expected = 0.0, together = 0.0, squares = 0.0;
        for (std::size_t i = seed % 17; i < kPixels; i += 17)
        {
            const double right = double(brightness(reference, i));
            const double own = double(brightness(image.radiance, i)) - right;
            const double first = double(brightness(film, i)) - right;
            sum += own + right;
            expected += right;
            together += own * first;
            squares += first * first;
        }
        mean.add(sum / expected);
        product.add(together / squares);
    }
    INFO(mean.mean() << " +- " << mean.standardError() << ", " << product.mean() << " +- "
                     << product.standardError());
    CHECK(mean.agrees(1.0, 0.003));
    CHECK(product.agrees(0.0, 0.01));
}

TEST_CASE("fresh samples: display values are averaged and decoded as those of the film",
          "[session]")
{
    Yard yard;
    yard.builder.scene->displayReferred = true;
    yard.builder.scene->lights.resize(1); // the sun has no noise
    OnePass pass(1, 0, IntegratorKind::Whitted, yard);
    SampledImage image = OnePass::black(20.0f);
    for (std::size_t i = 0; i < kPixels; i += 17)
        image.count[i] = 0.0f;
    pass.addTo(image);
    const std::vector<float> film = pass.session.resolveRadiance();
    int near = 0, all = 0;
    for (std::size_t i = 0; i < kPixels; i += 17)
    {
        ++all;
        near += std::abs(brightness(image.radiance, i) - brightness(film, i)) <
                0.001f * brightness(film, i);
    }
    CHECK(near > 0.8 * all); // but for edges
}

TEST_CASE("fresh samples: those of an image that looks through the middles of its pixels do so",
          "[session]")
{
    Yard yard;
    yard.builder.scene->lights.resize(1); // the sun has no noise
    OnePass pass(1, 0, IntegratorKind::Whitted, yard, true);
    SampledImage image = OnePass::black(20.0f);
    for (std::size_t i = 0; i < kPixels; i += 17)
        image.count[i] = 0.0f;
    pass.addTo(image);
    const std::vector<float> film = pass.session.resolveRadiance();
    for (std::size_t i = 0; i < kPixels; i += 17)
    {
        CAPTURE(i);
        REQUIRE(image.count[i] == 4.0f);
        REQUIRE(brightness(image.radiance, i) == Approx(brightness(film, i)).epsilon(1e-5));
    }
}

TEST_CASE("fresh samples: a pass that was given up for its time gets none", "[session]")
{
    const Yard yard;
    for (const bool givesUp : {false, true})
    {
        CAPTURE(givesUp);
        const auto workers = std::make_shared<Workers>(1);
        RenderSession session(workers);
        session.setView(yardView());
        session.setOptions(noisyOptions(0));
        ImageStages stages([] { return 0.0; });
        stages.reset(workers);
        stages.setMostKept(64.0f);
        const auto show = [&](float x, bool whole)
        {
            const ImageInputs inputs{traced(yard.at(x)), yardView(), noisyOptions(0)};
            session.setScene(inputs.scene);
            stages.leaveView(session, inputs);
            StopRule rule;
            rule.passes = 1;
            rule.shouldStop = [whole](int tiles, double) { return !whole && tiles > 0; };
            const RenderProgress result = session.render(rule);
            REQUIRE((result.passes == 1) == whole);
            int asked = 0; // whether to stop: before each of the tiles that get samples
            stages.enterView(session, inputs, result, [&asked] { return ++asked < 0; });
            return asked;
        };
        show(0.0f, true);
        const int asked = show(1.0f, !givesUp);
        CHECK(stages.versionsKept() == 1);
        CHECK((asked == 0) == givesUp);
    }
}

TEST_CASE("fresh samples: the shadow of a box that moves has a part of the noise", "[session]")
{
    const Yard yard;
    Watcher keeping(traced(yard.at(0.0f))), restarting(traced(yard.at(0.0f)), false);
    showMovingBox(yard, keeping, restarting);
    const auto last = yard.at(2.0f);
    const std::vector<float> reference = fresh(last, 9, 256), before = fresh(yard.at(1.0f), 9, 256),
                             kept = keeping.show(last), plain = restarting.show(last);
    const std::vector<uint8_t> box = pixelsOf(yard.box, last);
    double keptError = 0.0, plainError = 0.0;
    int pixels = 0;
    for (std::size_t i = 0; i < kPixels; ++i)
    {
        const float right = brightness(reference, i);
        if (box[i] || std::abs(brightness(before, i) - right) < 0.3f * right) continue;
        ++pixels;
        keptError += std::pow(double(brightness(kept, i)) - double(right), 2.0);
        plainError += std::pow(double(brightness(plain, i)) - double(right), 2.0);
    }
    INFO(pixels << " pixels: " << plainError << " to " << keptError);
    CHECK(pixels > 10);
    CHECK(keptError < 0.4 * plainError);
}
