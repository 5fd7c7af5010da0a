// GridBeamsTest.cpp - photon beams in fog beside volumes: closed forms, and the parts of a ray.
// SPDX-License-Identifier: MIT
#include "tests/integrators/VolumeScenes.h"
#include "tests/photons/BeamScenes.h"
#include "tests/photons/PhotonMeans.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr double kFog = 0.1;           ///< extinction of the fog of mirrorInFog()
constexpr double kEnd = 10.0;          ///< of the ray along +x
constexpr double kMirrorHeight = -1.0; ///< z of the mirror

/// A box of even smoke in the fog of mirrorInFog().
struct SmokeBox
{
    const char* name;
    Vec3 low, high;
    float extinction, albedo;
};

struct SmokeCase
{
    SmokeBox box;
    IntegratorKind kind;
};

/// Returns the length of what of a segment is within a box.
double lengthWithin(const SmokeBox& box, Vec3d from, Vec3d to)
{
    double begin = 0.0, end = 1.0;
    for (int k = 0; k < 3; ++k)
    {
        const double a = from[k], d = to[k] - a, low = double(box.low[k]),
                     high = double(box.high[k]);
        if (d == 0.0 && (a < low || a > high)) return 0.0;
        if (d == 0.0) continue;
        begin = std::max(begin, std::min((low - a) / d, (high - a) / d));
        end = std::min(end, std::max((low - a) / d, (high - a) / d));
    }
    return end > begin ? (end - begin) * glm::length(to - from) : 0.0;
}

/// Returns the radiance along +x from the origin that is scattered once: of the light, and with
/// mirrored of its image. Midpoint rule.
double scatteredOnce(const SmokeBox& box, bool mirrored)
{
    constexpr int kSteps = 100000;
    const Vec3d light(5, 0, 1), image(5, 0, -3), eye(0.0);
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i)
    {
        const Vec3d point(kEnd * (i + 0.5) / kSteps, 0, 0);
        const double sigma = double(box.extinction);
        const bool inside = lengthWithin(box, point - Vec3d(1e-9, 0, 0), point) > 0.0;
        const double scattering =
            kFog * double(kMirrorAlbedo) + (inside ? sigma * double(box.albedo) : 0.0);
        const double before = kFog * point.x + sigma * lengthWithin(box, eye, point);
        const auto add = [&](Vec3d from, double within)
        {
            const double d2 = glm::dot(from - point, from - point);
            const double depth = before + kFog * std::sqrt(d2) + sigma * within;
            sum += scattering / (4.0 * 3.14159265358979) * std::exp(-depth) / d2 * kEnd / kSteps;
        };
        add(light, lengthWithin(box, light, point));
        if (!mirrored) continue;
        const double share = (kMirrorHeight - image.z) / (point.z - image.z);
        const Vec3d foot = image + (point - image) * share;
        add(image, lengthWithin(box, light, foot) + lengthWithin(box, foot, point));
    }
    return sum;
}

Volume evenSmoke(const SmokeBox& box)
{
    Volume volume =
        densityIn(box.low, box.high, clumps(9), mediumOf(2.0f * box.extinction, box.albedo));
    makeEven(volume, Vec4(1.0f, 1.0f, 1.0f, 0.5f));
    return volume;
}

/// Returns the mean of what the ray sees for each of 16 seeds.
std::vector<double> bySeed(const std::shared_ptr<const TracedScene>& traced, RenderOptions options)
{
    std::vector<double> means;
    for (uint32_t seed = 0; seed < 16; ++seed)
    {
        options.seed = seed;
        const Picture picture = render(traced, alongMirror(), options, 16);
        REQUIRE(picture.progress.droppedSamples == 0);
        means.push_back(double(picture.mean().y));
    }
    return means;
}

Estimate estimateOf(const std::vector<double>& values)
{
    Estimate estimate;
    for (const double value : values)
        estimate.add(value);
    return estimate;
}

} // namespace

// The closed form of VolumePhotonsTest.cpp for fog, with a box of smoke somewhere. What photons
// bring is told from what paths bring by the same seeds, which sample the light alike. Each of the
// comparisons raises a false alarm in 1e4 seeds.
TEST_CASE("beams between volumes: the image of a light in a mirror shines in fog beside smoke",
          "[photons][statistics][volumes]")
{
    constexpr auto kSppm = IntegratorKind::Sppm, kCaustics = IntegratorKind::PhotonCaustics;
    constexpr float kDim = kMirrorAlbedo;
    const auto [box, kind] = GENERATE(
        SmokeCase{{"before the beams", {1.5f, -1, -0.5f}, {3, 1, 0.5f}, 0.5f, kDim}, kSppm},
        SmokeCase{{"absorbs there", {1.5f, -1, -0.5f}, {3, 1, 0.5f}, 0.5f, 0.0f}, kCaustics},
        SmokeCase{{"in their way", {3.5f, -1, -0.7f}, {5.5f, 1, -0.3f}, 2.0f, kDim}, kCaustics},
        SmokeCase{{"at the light", {4.6f, -0.4f, 0.6f}, {5.4f, 0.4f, 1.4f}, 2.0f, kDim}, kSppm},
        SmokeCase{{"at the eye", {-1, -1, -0.7f}, {2, 1, 0.6f}, 0.4f, kDim}, kCaustics},
        SmokeCase{{"along the ray", {-1, 0.05f, -0.5f}, {11, 1, 0.5f}, 0.02f, kDim}, kSppm});
    SceneBuilder builder = mirrorInFog();
    builder.scene->volumes.push_back(evenSmoke(box));
    const auto traced = builder.build();
    const double ofLight = scatteredOnce(box, false), ofImage = scatteredOnce(box, true) - ofLight;
    const std::vector<double> paths = bySeed(traced, optionsOf(IntegratorKind::Path, 2));
    CAPTURE(box.name, ofLight, ofImage);
    CHECK(estimateOf(paths).agrees(ofLight, 0.002 * ofLight)); // photons are for the image
    RenderOptions options = optionsOf(kind, 2);
    options.photons = 8000;
    options.photonRadius = 0.2f;
    std::vector<double> seen = bySeed(traced, options);
    for (std::size_t k = 0; k < seen.size(); ++k)
        seen[k] -= paths[k];
    const Estimate more = estimateOf(seen);
    CAPTURE(int(kind), more.mean() / ofImage, more.standardError() / ofImage);
    CHECK(more.agrees(ofImage, 0.01 * ofImage)); // the kernel's blur
    CHECK(more.standardError() < 0.06 * ofImage);
}
