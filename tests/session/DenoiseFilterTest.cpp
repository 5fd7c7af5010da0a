// DenoiseFilterTest.cpp - noise is removed, edges stay, and a converged image is left alone.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/denoise/DenoiseFilter.h"

#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"

#include <cmath>
#include <cstring>
#include <functional>
#include <random>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns a sample of a wall at distance 5 with albedo 1/2 that faces the eye.
SurfaceSample wall(Vec3 normal = Vec3(0, 0, 1), float distance = 5.0f, Vec3 albedo = Vec3(0.5f))
{
    return {normal, distance, albedo, 1};
}

struct TestImage
{
    TestImage(int w, int h, const std::function<SurfaceSample(int, int)>& surfaceAt,
              const std::function<Vec3(int, int)>& radianceAt)
    {
        image.width = w;
        image.height = h;
        for (int y = 0; y < h; ++y)
        {
            for (int x = 0; x < w; ++x)
            {
                surfaces.push_back(surfaceAt(x, y));
                const Vec3 radiance = radianceAt(x, y);
                image.radiance.insert(image.radiance.end(),
                                      {radiance.x, radiance.y, radiance.z, 1.0f});
            }
        }
    }

    void filter(int threads = 2)
    {
        const Workers workers(threads);
        DenoiseFilter denoise;
        denoise.setSurfaces(surfaces, image.width, image.height, workers);
        denoise.filter(image, workers);
    }

    /// Multiplies all channels of a pixel by 1 + sigma times a normal number, cut off at 0; the
    /// errors tell this noise.
    void addNoise(double sigma, bool withErrors, unsigned seed)
    {
        std::mt19937 random(seed);
        const NormalNumbers normal;
        if (withErrors) image.error.assign(image.radiance.size() / 4 * 3, 0.0f);
        for (std::size_t i = 0; i < image.radiance.size() / 4; ++i)
        {
            const double factor = std::max(0.0, 1.0 + sigma * normal(random));
            const double error = sigma * std::fabs(normal(random)); // two halves: one number
            for (std::size_t c = 0; c < 3; ++c)
            {
                if (withErrors)
                    image.error[3 * i + c] = static_cast<float>(error) * image.radiance[4 * i + c];
                image.radiance[4 * i + c] *= static_cast<float>(factor);
            }
        }
    }

    Vec3 at(int x, int y) const
    {
        const float* p = &image.radiance[4 * static_cast<std::size_t>(y * image.width + x)];
        return Vec3(p[0], p[1], p[2]);
    }

    ResolvedImage image;
    std::vector<SurfaceSample> surfaces;
};

double meanSquare(const std::vector<float>& a, const std::vector<float>& b)
{
    REQUIRE(a.size() == b.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += (double(a[i]) - b[i]) * (double(a[i]) - b[i]);
    return sum / static_cast<double>(a.size());
}

/// Returns the mean of the pixels' red over columns [left, right).
double meanOfColumns(const TestImage& t, int left, int right)
{
    double sum = 0.0;
    for (int y = 0; y < t.image.height; ++y)
        for (int x = left; x < right; ++x)
            sum += t.at(x, y).x;
    return sum / t.image.height / (right - left);
}

} // namespace

TEST_CASE("denoise: an even image is left as it is", "[session][denoise]")
{
    for (const bool withErrors : {false, true})
    {
        TestImage t(
            67, 35,
            [](int x, int y) {
                return wall(Vec3(0, 0, 1), 5.0f,
                            x < 20 ? Vec3(0.8f, 0.0f, 0.3f) : Vec3(0.1f * float(y % 7)));
            },
            [](int, int) { return Vec3(0); });
        for (std::size_t i = 0; i < t.surfaces.size(); ++i) // the irradiance is even
            for (int c = 0; c < 3; ++c)
                t.image.radiance[4 * i + std::size_t(c)] =
                    3.0f * std::max(t.surfaces[i].albedo[c], 0.02f);
        if (withErrors) t.image.error.assign(3 * t.surfaces.size(), 0.1f);
        const std::vector<float> before = t.image.radiance;
        t.filter();
        for (std::size_t i = 0; i < before.size(); ++i)
            REQUIRE(t.image.radiance[i] == Approx(before[i]).epsilon(2e-6));
    }
}

TEST_CASE("denoise: noise on a wall falls to a 300th, on a floor to a 120th", "[session][denoise]")
{
    // The surfaces are a wall that faces the eye, and a floor whose distance grows from row to row
    // up to tenfold.
    for (const bool floor : {false, true})
    {
        for (const bool withErrors : {false, true})
        {
            TestImage t(
                160, 90,
                [&](int, int y)
                { return floor ? wall(Vec3(0, 1, 0), 100.0f / float(100 - y)) : wall(); },
                [](int, int) { return Vec3(0.4f, 0.3f, 0.2f); });
            const std::vector<float> right = t.image.radiance;
            t.addNoise(0.5, withErrors, 7);
            const double before = meanSquare(t.image.radiance, right);
            t.filter();
            INFO("floor " << floor << ", errors " << withErrors);
            CHECK(meanSquare(t.image.radiance, right) < before / (floor ? 120.0 : 300.0));
        }
    }
}

TEST_CASE("denoise: edges of depth, of normals and of albedo keep their contrast",
          "[session][denoise]")
{
    constexpr int kWidth = 96, kEdge = 45; // in the middle of a cell
    const std::function<SurfaceSample(bool)> surfaces[] = {
        [](bool left) { return wall(Vec3(0, 0, 1), left ? 5.0f : 6.0f); },
        [](bool left) { return wall(left ? Vec3(0, 0, 1) : Vec3(0.6f, 0, 0.8f)); },
        [](bool left) { return wall(Vec3(0, 0, 1), 5.0f, Vec3(left ? 0.8f : 0.1f)); },
    };
    for (std::size_t kind = 0; kind < 3; ++kind)
    {
        TestImage t(
            kWidth, 64, [&](int x, int) { return surfaces[kind](x < kEdge); },
            [](int x, int) { return Vec3(x < kEdge ? 0.8f : 0.1f); });
        t.addNoise(0.5, false, 3);
        t.filter();
        INFO("kind " << kind);
        // The mean of a column has a hundredth of the noise left.
        CHECK(meanOfColumns(t, kEdge - 1, kEdge) == Approx(0.8).epsilon(0.1));
        CHECK(meanOfColumns(t, kEdge, kEdge + 1) == Approx(0.1).epsilon(0.1));
    }
}

TEST_CASE(
    "denoise: a shadow's edge, which no guide shows, keeps its contrast once errors are known",
    "[session][denoise]")
{
    for (const double sigma : {0.1, 0.03, 0.01})
    {
        TestImage t(
            96, 64, [](int, int) { return wall(); },
            [](int x, int) { return Vec3(x < 45 ? 0.8f : 0.1f); });
        t.addNoise(sigma, true, 3);
        t.filter();
        INFO("sigma " << sigma);
        const double contrast = (meanOfColumns(t, 44, 45) - meanOfColumns(t, 45, 46)) / 0.7;
        CHECK(contrast > 1.0 - 2.0 * sigma);
    }
}

TEST_CASE("denoise: lamps, mirrors and the background stay as they are and lend nothing",
          "[session][denoise]")
{
    const SurfaceSample background{Vec3(0), kInfinity, Vec3(0), 0};
    TestImage t(
        64, 32,
        [&](int x, int)
        {
            SurfaceSample s = x < 48 ? wall() : background;
            if (x >= 16 && x < 32) s.kind = x < 24 ? SurfaceKind::Emitting : SurfaceKind::Smooth;
            return s;
        },
        [](int x, int) { return Vec3(x >= 16 && (x < 32 || x >= 48) ? 50.0f : 1.0f); });
    t.addNoise(0.3, false, 11);
    const TestImage before = t;
    t.filter();
    int changed = 0;
    for (int y = 0; y < 32; ++y)
    {
        for (int x = 0; x < 64; ++x)
        {
            // Pixels beside the bright stripes may contain some of their light.
            const bool keeps = x >= 15 && (x < 33 || x >= 47);
            if (keeps)
                REQUIRE(t.at(x, y) == before.at(x, y));
            else
            {
                REQUIRE(t.at(x, y).x < 2.0f);
                changed += t.at(x, y) != before.at(x, y);
            }
        }
    }
    CHECK(changed > 850); // of 928
}

TEST_CASE("denoise: as errors fall, what is changed stays within them", "[session][denoise]")
{
    // The image has ripples of a period of 6 pixels that no guide shows.
    for (const double sigma : {0.3, 0.03, 0.003})
    {
        TestImage t(
            128, 96, [](int, int) { return wall(); },
            [](int x, int y) { return Vec3(0.5f + 0.2f * std::sin(float(x + y))); });
        const std::vector<float> right = t.image.radiance;
        t.addNoise(sigma, true, 5);
        const std::vector<float> before = t.image.radiance;
        const double noise = meanSquare(before, right);
        t.filter();
        INFO("sigma " << sigma);
        CHECK(meanSquare(t.image.radiance, before) < 1.2 * noise);
        CHECK(meanSquare(t.image.radiance, right) < 1.2 * noise);
    }
}

TEST_CASE("denoise: one bright pixel does not become a bright spot", "[session][denoise]")
{
    TestImage t(
        64, 64, [](int, int) { return wall(); }, [](int, int) { return Vec3(0.2f); });
    t.addNoise(0.3, false, 2);
    t.image.radiance[4 * (32 * 64 + 32)] = t.image.radiance[4 * (32 * 64 + 32) + 1] = 1e6f;
    t.filter();
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            REQUIRE(t.at(x, y).x < 0.6f);
}

TEST_CASE("denoise: what is not finite stays where it is", "[session][denoise]")
{
    const float bad[] = {kInfinity, -kInfinity, std::nanf("")};
    for (const float value : bad)
    {
        TestImage clean(
            64, 64, [](int, int) { return wall(); }, [](int, int) { return Vec3(0.2f); });
        clean.addNoise(0.3, true, 2);
        TestImage t = clean;
        const std::size_t pixel = 20 * 64 + 21, other = 40 * 64 + 40;
        t.image.radiance[4 * pixel] = value;
        t.image.error[3 * pixel] = value;
        t.image.error[3 * other] = value;
        t.surfaces[other + 1].normal = Vec3(value);
        t.surfaces[other + 2].distance = value;
        t.surfaces[other + 3].albedo = Vec3(value);
        t.filter();
        for (std::size_t i = 0; i < t.image.radiance.size(); ++i)
        {
            const bool same = std::memcmp(&t.image.radiance[i], &value, 4) == 0;
            REQUIRE((std::isfinite(t.image.radiance[i]) || (i == 4 * pixel && same)));
            if (i / 4 != pixel && i % 4 != 3) REQUIRE(t.image.radiance[i] < 0.6f);
        }
    }
}

TEST_CASE("denoise: alpha is kept and divided by first, and what is not there lends nothing",
          "[session][denoise]")
{
    // The image has a veil of alpha 1/4 on the left, an empty stripe, and a wall as bright as the
    // veil on the right.
    TestImage t(
        96, 32, [](int, int) { return wall(); }, [](int, int) { return Vec3(0.4f); });
    t.addNoise(0.3, false, 4);
    std::vector<float> alphas;
    for (int i = 0; i < 96 * 32; ++i)
    {
        const float alpha = i % 96 < 40 ? 0.25f : i % 96 < 50 ? 0.0f : 1.0f;
        for (std::size_t c = 0; c < 4; ++c)
            t.image.radiance[4 * std::size_t(i) + c] *= alpha;
        alphas.push_back(alpha);
    }
    t.filter();
    for (std::size_t i = 0; i < alphas.size(); ++i)
    {
        REQUIRE(t.image.radiance[4 * i + 3] == alphas[i]);
        if (alphas[i] == 0.0f)
            REQUIRE(t.image.radiance[4 * i] == 0.0f);
        else
            REQUIRE(t.image.radiance[4 * i] / alphas[i] ==
                    Approx(0.4).epsilon(0.35)); // single pixels: 30 % before
    }
}

TEST_CASE("denoise: any size, and an image of another size is left alone", "[session][denoise]")
{
    for (const int width : {1, 2, 3, 17, 257, 515})
    {
        for (const int height : {1, 2, 5})
        {
            TestImage t(
                width, height, [](int, int) { return wall(); },
                [](int, int) { return Vec3(0.2f); });
            t.addNoise(0.3, width % 2 == 0, 1);
            t.filter();
            for (const float value : t.image.radiance)
                REQUIRE((value >= 0.0f && value <= 1.0f));
        }
    }
    TestImage t(
        8, 8, [](int, int) { return wall(); }, [](int x, int) { return Vec3(0.1f * float(x)); });
    const std::vector<float> before = t.image.radiance;
    const Workers workers(1);
    DenoiseFilter denoise;
    denoise.filter(t.image, workers);
    CHECK(t.image.radiance == before);
    denoise.setSurfaces(t.surfaces, 4, 16, workers);
    denoise.filter(t.image, workers);
    CHECK(t.image.radiance == before);
}

namespace
{

/// Holds passes of the box before and after filtering.
struct Filtered
{
    std::vector<float> before, after;
    std::vector<float> error;
    std::vector<SurfaceSample> surfaces;
};

Filtered filteredBox(const std::shared_ptr<const TracedScene>& scene, int size, int passes,
                     uint32_t seed, int threads)
{
    const auto workers = std::make_shared<Workers>(threads);
    RenderSession session(workers);
    session.setScene(scene);
    session.setView(cornellView(size, size));
    session.setOptions(optionsOf(IntegratorKind::Path, 4, seed));
    StopRule rule;
    rule.passes = passes;
    REQUIRE(session.render(rule).status.ok());
    ResolvedImage image = session.resolvedImage();
    Filtered result;
    result.before = image.radiance;
    result.error = image.error;
    DenoiseFilter denoise;
    result.surfaces = session.surfaceSamples();
    denoise.setSurfaces(result.surfaces, size, size, *workers);
    denoise.filter(image, *workers);
    result.after = image.radiance;
    return result;
}

} // namespace

TEST_CASE("denoise: the box has the same pixels for any number of threads", "[session][denoise]")
{
    const auto scene = cornellBox().build();
    const Filtered one = filteredBox(scene, 61, 2, 1, 1);
    CHECK(one.after != one.before);
    CHECK(filteredBox(scene, 61, 2, 1, 2).after == one.after);
    CHECK(filteredBox(scene, 61, 2, 1, 5).after == one.after);
}

TEST_CASE("denoise: at one pass the box has a quarter of the error, at four half",
          "[session][denoise][statistics][long]")
{
    const auto scene = cornellBox().build();
    constexpr int kSize = 64;
    const Filtered converged = filteredBox(scene, kSize, 256, 99, 2);
    const std::vector<float>& right = converged.before;
    // The edges of the lamp and of the sky are as rough as before: by chance, pixels beside them
    // contain some of their light or none.
    const auto isEdge = [&](int pixel)
    {
        const int column = pixel % kSize, row = pixel / kSize;
        for (int y = std::max(row - 1, 0); y <= std::min(row + 1, kSize - 1); ++y)
            for (int x = std::max(column - 1, 0); x <= std::min(column + 1, kSize - 1); ++x)
            {
                const SurfaceSample& sample =
                    converged.surfaces[static_cast<std::size_t>(y * kSize + x)];
                if (sample.kind != SurfaceKind::Scattering || sample.object == 0) return true;
            }
        return false;
    };
    const auto relMse = [&](const std::vector<float>& image)
    {
        double sum = 0.0;
        for (std::size_t i = 0; i < image.size(); ++i)
            if (!isEdge(static_cast<int>(i / 4)))
                sum += std::pow(double(image[i]) - right[i], 2.0) /
                       (double(right[i]) * right[i] + 0.01);
        return sum / static_cast<double>(image.size());
    };
    for (const int passes : {1, 4})
    {
        for (const uint32_t seed : {1u, 2u})
        {
            const Filtered box = filteredBox(scene, kSize, passes, seed, 2);
            INFO("passes " << passes << ", before " << relMse(box.before) << ", after "
                           << relMse(box.after));
            // Many of the 64 x 64 pixels are edges, whose jitter the filter does not change.
            CHECK(relMse(box.after) < relMse(box.before) / (passes == 1 ? 4.0 : 2.0));
        }
    }
}

TEST_CASE("denoise: a converged box is left within its standard error", "[session][denoise][long]")
{
    const Filtered box = filteredBox(cornellBox().build(), 48, 1024, 1, 2);
    double variance = 0.0;
    for (const float error : box.error)
        variance += double(error) * error;
    variance /= static_cast<double>(box.error.size());
    CHECK(variance > 0.0);
    // The means are over RGBA, where alpha does not change, and are compared with means over RGB.
    CHECK(meanSquare(box.after, box.before) * 4.0 / 3.0 < variance);
}
