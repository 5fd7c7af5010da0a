// SamplerStudy.cpp - single receivers under the plane scenes' lights. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/SamplerStudy.h"

#include "apps/osgraytracebench/Timing.h"
#include "apps/osgraytracebench/report/PlaneScenes.h"
#include "apps/osgraytracebench/report/PreparedScene.h"
#include "apps/osgraytracebench/report/Slopes.h"

#include <cmath>

namespace osgRayTrace::bench
{

namespace
{

constexpr int kSide = 16;         ///< pixels of a receiver: independent runs
constexpr double kPixel = 1e-6;   ///< relative to the light's side
constexpr int kGroups = 16;       ///< groups of pixels: their scatter gives the standard errors
constexpr int kFewestFitted = 16; ///< slopes are fitted to larger numbers
constexpr uint32_t kSeed = 1;

struct Case
{
    std::string name;
    PlaneLighting lighting;
};

/// Returns a point in or around the penumbra of the edges and of the disc.
osg::Vec3d receiver(int index, int count)
{
    const double golden = 0.6180339887498949;
    const double x = -0.18 + 0.85 * (index + 0.5) / count;
    return osg::Vec3d(x, 0.6 * (std::fmod(golden * index, 1.0) - 0.5), 0.0);
}

/// Returns a scene whose view looks straight down from below the occluder.
ReportScene telescope(const Case& studied, const osg::Vec3d& point)
{
    ReportScene scene;
    scene.name = studied.name;
    scene.graph = planeGraph(studied.lighting);
    scene.view = osg::Matrixd::lookAt(point + osg::Vec3d(0, 0, 0.3), point, osg::Vec3d(0, 1, 0));
    const double half = 0.5 * kSide * kPixel;
    scene.projection = osg::Matrixd::ortho(-half, half, -half, half, 0.01, 1.0);
    return scene;
}

/// Holds the squared errors of one estimator: sums by group and number of samples.
struct Sums
{
    std::vector<std::vector<double>> squares; ///< group, then number of samples
    std::vector<double> samples;
    double seconds = 0.0, lightSamples = 0.0;

    explicit Sums(const std::vector<int>& counts)
        : squares(kGroups, std::vector<double>(counts.size())),
          samples(counts.begin(), counts.end())
    {
    }

    SamplerLine line(const Case& studied, const std::string& strategy, int receivers) const;
};

SamplerLine Sums::line(const Case& studied, const std::string& strategy, int receivers) const
{
    SamplerLine line;
    line.scene = studied.name;
    line.strategy = strategy;
    line.secondsPerSample = seconds / lightSamples;
    const double runs = static_cast<double>(receivers) * kSide * kSide / kGroups;
    std::vector<Series> series(kGroups);
    for (std::size_t n = 0; n < samples.size(); ++n)
    {
        std::vector<double> groups;
        for (std::size_t g = 0; g < kGroups; ++g)
        {
            groups.push_back(squares[g][n] / runs);
            if (samples[n] < kFewestFitted) continue;
            series[g].x.push_back(samples[n]);
            series[g].y.push_back(groups.back());
        }
        const Mean mean = meanOf(groups);
        line.points.push_back({static_cast<int>(samples[n]), mean.value, mean.error});
    }
    if (const std::optional<Slope> slope = logLogSlope(series))
    {
        line.slope = slope->value;
        line.slopeError = slope->error;
    }
    return line;
}

/// Holds E/L of each pixel, from the red of a picture of one pass.
struct Rendered
{
    std::vector<double> values;
    double seconds = 0.0;
};

Rendered render(const PreparedScene& prepared, const Method& method)
{
    const auto session = newSession(prepared, method, kSeed);
    engine::StopRule rule;
    rule.passes = 1;
    Rendered result;
    result.seconds = renderOn(*session, rule).seconds;
    const Pixels pixels = pixelsOf(*session);
    for (std::size_t i = 0; i < pixels.rgb.size(); i += 3)
        result.values.push_back(pixels.rgb[i] / planeScale().x());
    return result;
}

void addSquares(Sums& sums, std::size_t n, const std::vector<double>& values, double right)
{
    for (std::size_t i = 0; i < values.size(); ++i)
        sums.squares[i % kGroups][n] += (values[i] - right) * (values[i] - right);
}

/// Studies a strategy, and the ratio estimator with its samples.
void studyStrategy(const Case& studied, engine::LightSampling strategy,
                   const std::vector<int>& counts, int receivers,
                   const std::shared_ptr<engine::Workers>& workers, std::vector<SamplerLine>& lines)
{
    Sums full(counts), ratio(counts);
    const osg::Vec3d up(0, 0, 1);
    for (int r = 0; r < receivers; ++r)
    {
        const osg::Vec3d point = receiver(r, receivers);
        const double right =
            irradiance(studied.lighting.light, studied.lighting.occluder, point, up);
        const PreparedScene prepared =
            prepare(telescope(studied, point), atOrigin(), kSide, workers);
        for (std::size_t n = 0; n < counts.size(); ++n)
        {
            Method method = whittedMethod(strategy, counts[n]);
            const Rendered shadowed = render(prepared, method);
            addSquares(full, n, shadowed.values, right);
            full.seconds += shadowed.seconds;
            full.lightSamples += static_cast<double>(counts[n]) * kSide * kSide;
            if (studied.lighting.occluder.empty()) continue;

            // The samples are repeated without their shadows. A renderer would sum both at once, so
            // that the time of the repetition is not counted; the time of the formula at each pixel
            // is.
            method.options.shadows = false;
            std::vector<double> values = render(prepared, method).values;
            double open = 0.0;
            ratio.seconds +=
                shadowed.seconds + secondsOf(
                                       [&]
                                       {
                                           for (std::size_t i = 0; i < values.size(); ++i)
                                           {
                                               open = irradiance(studied.lighting.light, point, up);
                                               values[i] = open * shadowed.values[i] / values[i];
                                           }
                                       });
            ratio.lightSamples += static_cast<double>(counts[n]) * kSide * kSide;
            addSquares(ratio, n, values, right);
        }
    }
    const std::string name = whittedMethod(strategy, 1).name.substr(8); // without "WHITTED "
    lines.push_back(full.line(studied, name, receivers));
    if (!studied.lighting.occluder.empty())
        lines.push_back(ratio.line(studied, "ratio, " + name, receivers));
}

} // namespace

std::vector<SamplerLine> studySamplers(int receivers, int mostSamples,
                                       const std::shared_ptr<engine::Workers>& workers)
{
    std::vector<int> counts; // squares, and powers of two
    for (int n = 1; n <= mostSamples; n *= 4)
        counts.push_back(n);
    std::vector<SamplerLine> lines;
    for (const Case& studied :
         {Case{"open", squareLighting()}, Case{"axis edge", axisEdgeLighting()},
          Case{"rotated edge", rotatedEdgeLighting()},
          Case{"round blocker", roundBlockerLighting()}})
    {
        for (const engine::LightSampling strategy :
             {engine::LightSampling::Random, engine::LightSampling::UniformJitter,
              engine::LightSampling::Stratified, engine::LightSampling::Sobol})
            studyStrategy(studied, strategy, counts, receivers, workers, lines);
    }
    return lines;
}

} // namespace osgRayTrace::bench
