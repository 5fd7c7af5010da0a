// RatesTest.cpp - how fast the error of rendered photon maps falls: slopes, bias and variance by the formulas.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"
#include "tests/photons/Nephroid.h"

#include "osgRayTrace/photons/PhotonPasses.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kPixels = 16; ///< an edge of the patch that is looked at
constexpr double kPiD = glm::pi<double>();
constexpr int kCounts[] = {64, 128, 256, 512, 1024, 2048, 4096};
constexpr std::size_t kLast = 6;

/// A patch of floor whose radiance is known, pixel by pixel, also as a mean over discs.
struct Known
{
    SceneBuilder builder;
    Vec3d centre;
    double side;
    double (*mean)(double x, double y, double radius); ///< of what photons carry
    double (*direct)(double x, double y);
};

/// A point light at (0, 0, 1) beside a mirror at x = 1: its image is at (2, 0, 1). What falls onto the patch
/// from there has gone through the mirror wherever the patch's discs reach.
SceneBuilder flatMirror()
{
    SceneBuilder builder;
    builder.add(quadMesh({-2, -2, 0}, {2.9f, 0, 0}, {0, 4, 0}), lambert(Vec3(1.0f)));
    builder.add(quadMesh({1, 0.45f, 0.1f}, {0, -0.9f, 0}, {0, 0, 0.53f}), mirror(Vec3(1.0f)));
    builder.addLight(pointLight({0, 0, 1}));
    return builder;
}

/// Radiance of a white floor under a point light of intensity pi, one length above the foot.
double underLight(double x, double y) { return std::pow(1.0 + x * x + y * y, -1.5); }

/// To the fourth order of the radius: 1e-6 at the discs of this test. E = (1 + q)^-1.5, q the square of the
/// distance from the foot: its Laplacian is (9 q - 6) (1 + q)^-3.5.
double mirroredMean(double x, double y, double radius)
{
    const double q = (x - 2.0) * (x - 2.0) + y * y;
    return underLight(x - 2.0, y) +
           radius * radius / 8.0 * (9.0 * q - 6.0) * std::pow(1.0 + q, -3.5);
}

Known flatMirrorPatch() { return {flatMirror(), {0.1, 0, 0}, 0.8, mirroredMean, underLight}; }

/// Between the centre and the nephroid's cusp, where G rises from 1.4 to 5.
Known nephroidPatch()
{
    return {nephroid(), {0.28, 0, 0}, 0.24, meanGain, [](double, double) { return 1.0; }};
}

/// Means over the pixels and runs of the error over the true value, of its square, and of what theory
/// says about both, at each of kCounts.
struct Errors
{
    std::vector<Estimate> relative, squared; ///< a run
    std::vector<double> slopes;              ///< of the squared error, a run
};

/// Radiance of the pixels by photons and by direct light, without noise: means over discs of the pixel's
/// second moments.
std::vector<double> truth(const Known& known, double photonShareRadius)
{
    std::vector<double> values;
    const double step = known.side / kPixels;
    for (int k = 0; k < kPixels * kPixels; ++k)
    {
        // patchView looks down with +x up: see Picture's rows.
        const double x = known.centre.x + ((k / kPixels + 0.5) / kPixels - 0.5) * known.side;
        const double y = known.centre.y - ((k % kPixels + 0.5) / kPixels - 0.5) * known.side;
        const double pixelRadius = step / std::sqrt(3.0);
        values.push_back(known.mean(x, y, std::hypot(pixelRadius, photonShareRadius)) +
                         (photonShareRadius == 0.0 ? known.direct(x, y) : 0.0));
    }
    return values;
}

Errors measured(const Known& known, RenderOptions options, int runs)
{
    const auto traced = known.builder.build();
    const std::vector<double> expected = truth(known, 0.0);
    Errors errors;
    errors.relative.resize(kLast + 1);
    errors.squared.resize(kLast + 1);
    for (int run = 0; run < runs; ++run)
    {
        RenderSession session(std::make_shared<Workers>(1));
        session.setScene(traced);
        session.setView(patchView(known.centre, {0, 0, 1}, known.side, kPixels));
        options.seed = 77 + static_cast<uint32_t>(run);
        session.setOptions(options);
        std::vector<double> counts, squares;
        for (std::size_t at = 0; at <= kLast; ++at)
        {
            StopRule rule;
            rule.passes = kCounts[at];
            const RenderProgress progress = session.render(rule);
            REQUIRE(progress.passes == kCounts[at]);
            REQUIRE(progress.droppedSamples == 0);
            const std::vector<float> rgba = session.resolveRadiance();
            double relative = 0.0, squared = 0.0;
            for (std::size_t k = 0; k < expected.size(); ++k)
            {
                const double error = double(rgba[4 * k + 1]) / expected[k] - 1.0;
                relative += error / double(expected.size());
                squared += error * error / double(expected.size());
            }
            errors.relative[at].add(relative);
            errors.squared[at].add(squared);
            counts.push_back(kCounts[at]);
            squares.push_back(squared);
        }
        errors.slopes.push_back(logLogSlope(counts, squares));
    }
    return errors;
}

void checkSlope(const char* name, const Known& known, RenderOptions options, int runs)
{
    const Errors errors = measured(known, options, runs);
    Estimate slope;
    for (const double s : errors.slopes)
        slope.add(s);
    std::vector<double> counts, squares;
    for (std::size_t at = 0; at <= kLast; ++at)
    {
        counts.push_back(kCounts[at]);
        squares.push_back(errors.squared[at].mean());
    }
    const double fitted = logLogSlope(counts, squares);
    CAPTURE(name, int(options.integrator), int(options.radiusSchedule), options.photonAlpha, fitted,
            slope.mean(), slope.standardError(), squares[0], squares[kLast],
            errors.relative[0].mean(), errors.relative[kLast].mean());
    CHECK(slope.standardError() < 0.02);
    CHECK(fitted == Approx(-double(options.photonAlpha)).margin(0.07));
}

RenderOptions optionsFor(IntegratorKind kind, RadiusSchedule schedule, int photons, float radius)
{
    RenderOptions options = optionsOf(kind, 1);
    options.radiusSchedule = schedule;
    options.photons = photons;
    options.photonRadius = radius;
    return options;
}

} // namespace

TEST_CASE("rates: mean square error of a flat mirror's light", "[photons][statistics]")
{
    const Known known = flatMirrorPatch();
    checkSlope("flat mirror", known,
               optionsFor(IntegratorKind::PhotonCaustics, RadiusSchedule::Global, 256, 0.06f), 6);
    checkSlope("flat mirror", known,
               optionsFor(IntegratorKind::Sppm, RadiusSchedule::Local, 1024, 0.06f), 4);
}

TEST_CASE("rates: mean square error of the nephroid's light", "[photons][statistics]")
{
    const Known known = nephroidPatch();
    checkSlope("nephroid", known,
               optionsFor(IntegratorKind::PhotonCaustics, RadiusSchedule::Global, 1024, 0.04f), 4);
    checkSlope("nephroid", known,
               optionsFor(IntegratorKind::Sppm, RadiusSchedule::Local, 2048, 0.04f), 3);
}
