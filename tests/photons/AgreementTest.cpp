// AgreementTest.cpp - photon mapping and path tracing show the same light on every kind of scene.
// SPDX-License-Identifier: MIT
#include "tests/PValues.h"
#include "tests/photons/PhotonMeans.h"
#include "tests/photons/PhotonScenes.h"

#include "osgRayTrace/integrators/shared/HitPoints.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kSize = 24;
constexpr int kBounces = 24; ///< longer paths carry no noticeable light

/// Checks that photons agree with paths. All comparisons of a list of scenes together raise a false
/// alarm with a probability of 1 %.
void checkAgreement(const std::vector<ComparedScene>& scenes)
{
    const double threshold = sidak(0.01, 3 * static_cast<int>(scenes.size()));
    for (const ComparedScene& scene : scenes)
    {
        RenderOptions options = optionsOf(IntegratorKind::Path, kBounces);
        const Estimate path = meanOf(scene.traced, scene.view, options, 32);
        REQUIRE(path.mean() > 0.02);
        CHECK(path.standardError() < 6e-3 * path.mean());
        for (const IntegratorKind kind :
             {IntegratorKind::Sppm, IntegratorKind::Ppm, IntegratorKind::PhotonCaustics})
        {
            options.integrator = kind;
            options.photons = 6000;
            // At edges, discs lose light to places without a surface: 0.1 % of the picture at these
            // radii. Discs of PHOTON_CAUSTICS collect photons after a bounce, too: small discs
            // collect them seldom and brightly.
            const bool caustics = kind == IntegratorKind::PhotonCaustics;
            options.photonRadius = static_cast<float>((caustics ? 0.01 : 0.004) * scene.size);
            const int passes = kind == IntegratorKind::Ppm ? 12 * kPathPasses : 12; // equal paths
            const Estimate photons = meanOf(scene.traced, scene.view, options, passes);
            const double p = welchTest(path, kRuns, photons, kRuns);
            CAPTURE(scene.name, int(kind), path.mean(), path.standardError(), photons.mean(),
                    photons.standardError(), p, threshold);
            CHECK(photons.standardError() < 0.015 * path.mean());
            CHECK(p > threshold);
        }
    }
}

} // namespace

TEST_CASE("photons and paths agree: ten scenes of all kinds", "[photons][statistics]")
{
    checkAgreement(tenScenes(kSize, kSize));
}

TEST_CASE("photons and paths agree: what photons find hard", "[photons][statistics]")
{
    checkAgreement(photonScenes(kSize, kSize));
}

TEST_CASE("photons and paths agree: no terminator in mirrors", "[photons]")
{
    // Facets with a terminator offset take light from below their planes, where no photon lands.
    // Mirrors must not do so: a coarse mirror ball gave 0.2 % of the light of its room twice.
    for (const ComparedScene& scene : photonScenes(kSize, kSize))
    {
        if (std::string(scene.name) != "smooth mirror balls") continue;
        for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted,
                                          IntegratorKind::Sppm, IntegratorKind::PhotonCaustics})
        {
            CAPTURE(int(kind));
            RenderOptions options = optionsOf(kind, kBounces);
            const Picture on = render(scene.traced, scene.view, options, 4);
            options.terminatorCorrection = false;
            CHECK(on.rgba == render(scene.traced, scene.view, options, 4).rgba);
            CHECK(luminance(on.mean()) > 0.02f);
        }
        return;
    }
    FAIL("the scene is gone");
}
