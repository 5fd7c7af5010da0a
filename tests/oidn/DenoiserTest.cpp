// DenoiserTest.cpp - how Open Image Denoise is called, and what replaces it if it fails. StandIn.h
// stands for the library.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/denoise/Denoiser.h"

#include "osgRayTrace/base/Parallel.h"
#include "tests/Catch.h"
#include "tests/oidn/StandIn.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Holds a noisy picture of a wall of albedo 1/2 that faces the eye.
struct NoisyWall
{
    NoisyWall(int width, int height)
    {
        const auto pixels = static_cast<std::size_t>(width * height);
        image.width = width;
        image.height = height;
        std::mt19937 random(7);
        std::uniform_real_distribution<float> light(0.0f, 2.0f);
        for (std::size_t i = 0; i < pixels; ++i)
            image.radiance.insert(image.radiance.end(),
                                  {light(random), light(random), light(random), 1.0f});
        surfaces.assign(pixels, {Vec3(0, 0, 1), 5.0f, Vec3(0.5f), 1});
    }

    const float* at(int x, int y) const
    {
        return &image.radiance[4 * static_cast<std::size_t>(y * image.width + x)];
    }
    float* at(int x, int y) { return const_cast<float*>(std::as_const(*this).at(x, y)); }
    SurfaceSample& surfaceAt(int x, int y)
    {
        return surfaces[static_cast<std::size_t>(y * image.width + x)];
    }

    void denoise(Denoiser& denoiser, DenoiseKind kind, int threads = 2)
    {
        const Workers workers(threads);
        denoiser.denoise(
            image, kind,
            [this]() -> const std::vector<SurfaceSample>&
            {
                ++timesAsked;
                return surfaces;
            },
            workers);
    }

    ResolvedImage image;
    std::vector<SurfaceSample> surfaces;
    int timesAsked = 0; ///< for the surfaces
};

bool sameBits(const float* a, const float* b, std::size_t count)
{
    return std::memcmp(a, b, count * sizeof(float)) == 0;
}

using Calls = std::vector<std::string>;

} // namespace

TEST_CASE("oidn: device and network are made once, and anew for other threads or another size",
          "[session][oidn]")
{
    StandIn& library = beginStandIn();
    {
        Denoiser denoiser;
        NoisyWall(8, 6).denoise(denoiser, DenoiseKind::Oidn);
        CHECK(library.calls == Calls{"new device", "device, threads 2", "new RT",
                                     "filter 8x6 cleanAux hdr", "execute"});
        CHECK(denoiser.report().by == DenoiseKind::Oidn);
        CHECK(denoiser.report().note.empty());

        library.calls.clear();
        NoisyWall(8, 6).denoise(denoiser, DenoiseKind::Oidn);
        denoiser.forgetSurfaces(); // as for another view of the same size
        NoisyWall(8, 6).denoise(denoiser, DenoiseKind::Oidn);
        CHECK(library.calls == Calls{"execute", "execute"});

        library.calls.clear();
        denoiser.forgetSurfaces();
        NoisyWall(6, 8).denoise(denoiser, DenoiseKind::Oidn);
        CHECK(library.calls == Calls{"new RT", "filter 6x8 cleanAux hdr", "execute"});

        library.calls.clear();
        NoisyWall(6, 8).denoise(denoiser, DenoiseKind::Oidn, 3);
        CHECK(library.calls == Calls{"new device", "device, threads 3", "new RT",
                                     "filter 6x8 cleanAux hdr", "execute"});
        CHECK(library.devices == 1);
        CHECK(library.filters == 1);
    }
    CHECK(library.devices == 0);
    CHECK(library.filters == 0);
    CHECK(library.mistakes == Calls{});
}

TEST_CASE("oidn: the network is given light over alpha, and guides within their ranges",
          "[session][oidn]")
{
    StandIn& library = beginStandIn();
    NoisyWall wall(5, 4);
    wall.at(1, 2)[3] = 0.25f;
    wall.surfaceAt(0, 0).albedo = Vec3(0.25f, 1.5f, kNan);
    wall.surfaceAt(1, 0).kind = SurfaceKind::Smooth;
    wall.surfaceAt(2, 0).kind = SurfaceKind::Emitting;
    wall.surfaceAt(3, 0) = {Vec3(0), kInfinity, Vec3(0.3f), 0};
    wall.surfaceAt(4, 0).normal = Vec3(0.0f, -0.6f, 0.8f);
    wall.surfaceAt(0, 1).normal = Vec3(kNan, 2.0f, -1.0f);
    const NoisyWall before = wall;
    Denoiser denoiser;
    wall.denoise(denoiser, DenoiseKind::Oidn);
    REQUIRE(library.mistakes == Calls{});
    REQUIRE(library.light.size() == 60);

    const auto pixel = [](const std::vector<float>& values, int i)
    {
        return Vec3(values[3 * std::size_t(i)], values[3 * std::size_t(i) + 1],
                    values[3 * std::size_t(i) + 2]);
    };
    const float* thin = before.at(1, 2);
    CHECK(pixel(library.light, 11) == Vec3(4 * thin[0], 4 * thin[1], 4 * thin[2]));
    const float* whole = before.at(2, 2);
    CHECK(pixel(library.light, 12) == Vec3(whole[0], whole[1], whole[2]));
    CHECK(pixel(library.albedo, 0) == Vec3(0.25f, 1.0f, 0.0f));
    CHECK(pixel(library.albedo, 1) == Vec3(1));
    CHECK(pixel(library.albedo, 2) == Vec3(1));
    CHECK(pixel(library.albedo, 3) == Vec3(0));
    CHECK(pixel(library.albedo, 4) == Vec3(0.5f));
    CHECK(pixel(library.normal, 3) == Vec3(0));
    CHECK(pixel(library.normal, 4) == Vec3(0.0f, -0.6f, 0.8f));
    CHECK(pixel(library.normal, 5) == Vec3(0.0f, 0.0f, -1.0f));

    // The library's result, here the mean of 3 x 3 pixels, is multiplied by alpha again, and alpha
    // stays as it is.
    Vec3 mean(0);
    for (int y = 1; y <= 3; ++y)
        for (int x = 0; x <= 2; ++x)
            mean += pixel(library.light, 5 * y + x) / 9.0f;
    for (int c = 0; c < 3; ++c)
        CHECK(wall.at(1, 2)[c] == Approx(0.25f * mean[c]).epsilon(1e-5));
    for (int i = 0; i < 20; ++i)
        CHECK(wall.at(i % 5, i / 5)[3] == before.at(i % 5, i / 5)[3]);
}

TEST_CASE("oidn: pixels that are not there or not finite stay as they are, bit for bit",
          "[session][oidn]")
{
    StandIn& library = beginStandIn();
    NoisyWall wall(6, 5);
    wall.at(0, 0)[1] = kNan;
    wall.at(1, 0)[0] = kInfinity;
    wall.at(2, 0)[3] = 0.0f;
    wall.at(3, 0)[3] = kNan;
    wall.at(4, 0)[2] = 1e25f;
    wall.at(5, 0)[0] = -0.5f; // negative light, but finite: the pixel is filtered
    const NoisyWall before = wall;
    Denoiser denoiser;
    wall.denoise(denoiser, DenoiseKind::Oidn);
    CHECK(library.mistakes == Calls{});
    for (int x = 0; x < 5; ++x)
        CHECK(sameBits(wall.at(x, 0), before.at(x, 0), 4));
    CHECK_FALSE(sameBits(wall.at(5, 0), before.at(5, 0), 4));
    for (std::size_t i = 0; i < 15; ++i)
        CHECK(library.light[i] == 0.0f);
    for (int y = 1; y < 5; ++y)
        for (int x = 0; x < 6; ++x)
            CHECK_FALSE(sameBits(wall.at(x, y), before.at(x, y), 4));
}

TEST_CASE(
    "oidn: whatever of it fails, the filter takes its place, says why and nothing is tried again",
    "[session][oidn]")
{
    struct Failure
    {
        Fault fault;
        const char* message;
    };
    for (const Failure& failure : {Failure{Fault::NewDevice, "no such device"},
                                   Failure{Fault::CommitDevice, "the device will not"},
                                   Failure{Fault::NewFilter, "no such filter"},
                                   Failure{Fault::CommitFilter, "the filter will not"},
                                   Failure{Fault::Execute, "out of luck"}})
    {
        INFO(failure.message);
        NoisyWall filtered(20, 14);
        Denoiser ours;
        filtered.denoise(ours, DenoiseKind::Filter);
        REQUIRE(ours.report().by == DenoiseKind::Filter);

        StandIn& library = beginStandIn(failure.fault);
        Denoiser denoiser;
        for (int image = 0; image < 2; ++image)
        {
            NoisyWall wall(20, 14);
            wall.denoise(denoiser, DenoiseKind::Oidn);
            CHECK(sameBits(wall.at(0, 0), filtered.at(0, 0), wall.image.radiance.size()));
            CHECK(denoiser.report().by == DenoiseKind::Filter);
            CHECK(denoiser.report().note ==
                  std::string("denoise oidn: Open Image Denoise failed (") + failure.message +
                      "); denoise filter takes its place");
            CHECK(library.times("new device") == (image == 0 ? 1 : 0));
            CHECK(library.devices == 0);
            CHECK(library.filters == 0);
            CHECK(library.mistakes == Calls{});
            library.calls.clear();
        }
        NoisyWall plain(20, 14);
        plain.denoise(denoiser, DenoiseKind::Filter);
        CHECK(denoiser.report().note.empty());
    }
}

TEST_CASE("oidn: surfaces are asked for once for each denoiser that needs them", "[session][oidn]")
{
    beginStandIn();
    NoisyWall wall(8, 8);
    Denoiser denoiser;
    wall.denoise(denoiser, DenoiseKind::Off);
    CHECK(wall.timesAsked == 0);
    CHECK(denoiser.report().by == DenoiseKind::Off);
    for (const DenoiseKind kind : {DenoiseKind::Oidn, DenoiseKind::Filter, DenoiseKind::Oidn})
        wall.denoise(denoiser, kind);
    CHECK(wall.timesAsked == 2);
    denoiser.forgetSurfaces();
    wall.denoise(denoiser, DenoiseKind::Oidn);
    wall.denoise(denoiser, DenoiseKind::Oidn);
    CHECK(wall.timesAsked == 3);
}
