// SphereTest.cpp - an integrating sphere is lit evenly by photons, and a diffuse room carries light
// equally both ways.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/PValues.h"

#include "osgRayTrace/photons/PhotonPasses.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr double kRho = 0.5, kExponent = 1.0, kPiD = glm::pi<double>();

Light offCentreSpot()
{
    Light spot = pointLight(Vec3(0.45f, -0.2f, 0.3f));
    spot.direction = glm::normalize(Vec3(0.3f, 0.2f, 1.0f));
    spot.spotExponent = static_cast<float>(kExponent);
    spot.spotCosCutoff = static_cast<float>(std::cos(1.2));
    return spot;
}

/// Returns a sphere of 100 rows of facets. PHOTON_CAUSTICS has photons for it only if something
/// bends light. So, if bent is true, there is a small ball without an interface, off all paths of
/// light that are measured.
SceneBuilder integratingSphere(bool bent)
{
    SceneBuilder sphere;
    sphere.add(sphereMesh(Vec3(0.0f), 1.0f, 100), lambert(Vec3(float(kRho))));
    sphere.addLight(offCentreSpot());
    if (bent) sphere.add(sphereMesh({0.2f, 0.1f, 0.55f}, 0.15f, 8), glass(1.0f));
    return sphere;
}

/// Returns places around the sphere that the spot does not light.
std::vector<Vec3d> darkPlaces()
{
    const Light spot = offCentreSpot();
    std::vector<Vec3d> places;
    for (int i = 0; i < 14; ++i)
    {
        const double z = -0.93 + 0.14 * i, phi = 2.4 * i + 0.1, r = std::sqrt(1.0 - z * z);
        const Vec3d n(r * std::cos(phi), r * std::sin(phi), z);
        const Vec3d towards = glm::normalize(n - Vec3d(spot.position));
        if (glm::dot(towards, Vec3d(spot.direction)) > double(spot.spotCosCutoff) - 0.05) continue;
        places.push_back(n);
    }
    return places;
}

/// Returns the radiance of each place, with one value for each of 12 seeds. The views share their
/// photons.
std::vector<Estimate> radiances(const std::shared_ptr<const TracedScene>& traced,
                                const std::vector<Vec3d>& places, RenderOptions options, int passes,
                                int pixels)
{
    const auto workers = std::make_shared<Workers>(0);
    std::vector<Estimate> result(places.size());
    for (uint32_t seed = 0; seed < 12; ++seed)
    {
        options.seed = seed;
        const auto photons = std::make_shared<PhotonPasses>();
        std::vector<std::unique_ptr<RenderSession>> sessions;
        for (const Vec3d& place : places)
        {
            sessions.push_back(std::make_unique<RenderSession>(workers, photons));
            sessions.back()->setScene(traced);
            sessions.back()->setView(patchView(place * 0.999, -place, 0.02, pixels));
            sessions.back()->setOptions(options);
        }
        for (int pass = 1; pass <= passes; ++pass)
            for (const auto& session : sessions)
            {
                StopRule rule;
                rule.passes = pass;
                REQUIRE(session->render(rule).droppedSamples == 0);
            }
        for (std::size_t k = 0; k < places.size(); ++k)
        {
            const std::vector<float> rgba = sessions[k]->resolveRadiance();
            double sum = 0.0;
            for (std::size_t i = 0; i < rgba.size(); i += 4)
                sum += double(rgba[i + 1]) * 4.0 / double(rgba.size());
            result[k].add(sum);
        }
    }
    return result;
}

} // namespace

// E_ind = rho Phi / (4 pi R^2 (1 - rho)) holds wherever the spot is and shines. Seven places or
// more are measured by two estimators, each within 4 standard errors of 12 values and a bias of 0.4
// %: the facets have 0.25 % of it, and photons leave out some light at their planes. A false alarm
// of all has a probability of 0.03; the seeds are fixed.
TEST_CASE("integrating sphere: photons light all of it alike",
          "[photons][statistics][stability 48]")
{
    const double flux =
        2.0 * kPiD * kPiD * (1.0 - std::pow(std::cos(1.2), kExponent + 1)) / (kExponent + 1);
    const double expected = kRho / kPiD * kRho * flux / (4.0 * kPiD * (1.0 - kRho));
    const std::vector<Vec3d> places = darkPlaces();
    REQUIRE(places.size() >= 7);
    for (const IntegratorKind kind : {IntegratorKind::Sppm, IntegratorKind::PhotonCaustics})
    {
        const bool caustics = kind == IntegratorKind::PhotonCaustics;
        RenderOptions options = optionsOf(kind, 16);
        options.photons = 20000;
        options.photonRadius = 0.2f;
        const std::vector<Estimate> values =
            radiances(integratingSphere(caustics).build(), places, options, caustics ? 32 : 24,
                      caustics ? 16 : 4);
        double low = 1e9, high = 0.0, noise = 0.0;
        for (std::size_t k = 0; k < places.size(); ++k)
        {
            CAPTURE(int(kind), k, values[k].mean(), expected, values[k].standardError());
            CHECK(values[k].agrees(expected, 4e-3 * expected));
            CHECK(values[k].standardError() < 1e-2 * expected);
            low = std::min(low, values[k].mean());
            high = std::max(high, values[k].mean());
            noise = std::max(noise, values[k].standardError());
        }
        CAPTURE(int(kind), low, high, noise);
        CHECK(high - low <= 5e-3 * expected + 8.0 * noise);
    }
}

TEST_CASE("diffuse room: photons carry as much from A to B as from B to A",
          "[photons][statistics][stability 49]")
{
    // Two equal patches of one albedo are on the floor and on the back wall of the Cornell box
    // without its lamp; one of them shines with radiance 10. The means are compared by Welch's
    // test, p > 1e-3.
    constexpr float kSide = 120.0f;
    const struct
    {
        Vec3 corner, u, v;
    } patches[2] = {{{60, 1, 300}, {0, 0, kSide}, {kSide, 0, 0}},
                    {{400, 240, 558}, {0, kSide, 0}, {kSide, 0, 0}}};
    Estimate radiance[2];
    for (int seen = 0; seen < 2; ++seen)
    {
        SceneBuilder box = cornellBox();
        box.scene->lights.clear();
        for (Instance& instance : box.scene->instances)
            if (instance.light != kInvalid)
            {
                instance.light = kInvalid;
                box.scene->materials[instance.material] = lambert(Vec3(0.73f));
            }
        for (int i = 0; i < 2; ++i)
        {
            const auto& p = patches[i];
            if (i == seen)
            {
                box.add(quadMesh(p.corner, p.u, p.v), lambert(Vec3(0.6f)));
                continue;
            }
            box.addQuadLight(p.corner, p.u, p.v, Vec3(10.0f));
            box.scene->materials.back().baseColor = Vec3(0.6f);
        }
        const auto traced = box.build();
        const auto& p = patches[seen];
        RenderOptions options = optionsOf(IntegratorKind::Sppm, 16);
        options.photons = 20000;
        options.photonRadius = 4.0f;
        for (uint32_t seed = 0; seed < 16; ++seed)
        {
            options.seed = 100 * static_cast<uint32_t>(seen) + seed;
            const View view = patchView(Vec3d(p.corner + 0.5f * (p.u + p.v)),
                                        glm::normalize(Vec3d(glm::cross(p.u, p.v))), kSide, 16);
            radiance[seen].add(double(render(traced, view, options, 24).mean().y));
        }
    }
    const double p = welchTest(radiance[0], 16, radiance[1], 16);
    CAPTURE(radiance[0].mean(), radiance[0].standardError(), radiance[1].mean(),
            radiance[1].standardError(), p);
    CHECK(p > 1e-3);
    CHECK(radiance[0].standardError() < 6e-3 * radiance[0].mean());
    CHECK(radiance[1].standardError() < 6e-3 * radiance[1].mean());
}
