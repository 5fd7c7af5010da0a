// PhotonGuidingTest.cpp - photons go where views see their light, and their mean stays the same.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"

#include "osgRayTrace/integrators/IntegratorFactory.h"
#include "osgRayTrace/photons/PhotonPasses.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kSize = 32;
constexpr float kStep = 2.0f;
constexpr int kBalls = 48;          ///< in two rows
const Vec3 kSeen(9.0f, 0.0f, 0.0f); ///< on the floor below one of the balls

/// Returns a long floor with glass balls in two rows, many more than a view shows.
SceneBuilder hall()
{
    SceneBuilder builder;
    builder.add(quadMesh({-30, -3, 0}, {60, 0, 0}, {0, 8, 0}), lambert(Vec3(0.6f)));
    for (int k = 0; k < kBalls; ++k)
    {
        const Vec3 centre(kStep * static_cast<float>(k / 2) - 23.0f, k % 2 ? 0.0f : 2.0f, 0.6f);
        auto ball = sphereMesh(centre, 0.4f, 24);
        std::vector<Vec3> normals;
        for (const Vec3& p : ball->positions)
            normals.push_back(glm::normalize(p - centre));
        ball->normals = std::move(normals);
        builder.add(ball, glass(1.5f));
    }
    return builder;
}

Light sun()
{
    Light light;
    light.kind = LightKind::Directional;
    light.direction = glm::normalize(Vec3(0.15f, 0.1f, -1.0f));
    light.diffuse = Vec3(1.0f);
    return light;
}

enum Lit
{
    ByLamp,
    BySun,
    ByMany,
};

/// Returns the lit hall. ByMany adds lights of every kind, most of which light invisible surfaces.
SceneBuilder litHall(Lit lit)
{
    SceneBuilder builder = hall();
    if (lit == ByLamp) builder.addQuadLight({0, 0, 14}, {0, 0.5f, 0}, {0.5f, 0, 0}, Vec3(2000.0f));
    if (lit == BySun) builder.addLight(sun());
    if (lit != ByMany) return builder;
    for (int k = 0; k < 9; ++k)
    {
        const Vec3 at(6.0f * static_cast<float>(k) - 24.0f, 0.5f, 4.0f);
        if (k % 3 == 0) builder.addQuadLight(at, {0, 0.4f, 0}, {0.4f, 0, 0}, Vec3(40.0f), k == 3);
        if (k % 3 == 1) builder.addEmissive(sphereMesh(at, 0.2f, 6), lamp(Vec3(30, 20, 10)));
        Light spot = pointLight(at, Vec3(2.0f));
        spot.spotCosCutoff = k == 2 ? -1.0f : 0.5f;
        spot.direction = Vec3(0, 0, -1);
        spot.spotExponent = 2.0f;
        if (k % 3 == 2) builder.addLight(spot);
    }
    Light weak = sun();
    weak.diffuse = Vec3(0.05f);
    builder.addLight(weak);
    return builder;
}

/// Returns a view of one ball and its light on the floor.
View viewOfOne(Vec3 at = kSeen, int size = kSize)
{
    const Vec3d centre(at);
    return perspectiveView(centre + Vec3d(0.3, -4, 4), centre + Vec3d(0, 0, 0.2), {0, 0, 1}, 24.0,
                           size, size);
}

RenderOptions guidingOptions(IntegratorKind kind, bool guided)
{
    RenderOptions options = optionsOf(kind);
    options.photons = 8192;
    options.photonRadius = 0.06f;
    options.photonGuiding = guided;
    return options;
}

struct SharedSession
{
    explicit SharedSession(const std::shared_ptr<const TracedScene>& traced,
                           const RenderOptions& options, const View& view,
                           std::shared_ptr<PhotonPasses> passes = {}, int threads = 2)
        : photons(passes ? std::move(passes) : std::make_shared<PhotonPasses>()),
          session(std::make_shared<Workers>(threads), photons)
    {
        session.setScene(traced);
        session.setOptions(options);
        session.setView(view);
    }

    RenderProgress upTo(int passes)
    {
        StopRule rule;
        rule.passes = passes;
        return session.render(rule);
    }

    std::shared_ptr<PhotonPasses> photons;
    RenderSession session;
};

/// Counts the photons of the session's last pass on the floor around a point.
uint32_t photonsAround(SharedSession& s, const std::shared_ptr<const TracedScene>& traced,
                       const RenderOptions& options, int pass, Vec3 at)
{
    PhotonPassOptions passOptions;
    passOptions.use = photonUse(options.integrator);
    passOptions.photons = static_cast<uint32_t>(options.photons);
    passOptions.maxBounces = options.maxBounces;
    passOptions.seed = options.seed;
    passOptions.photonGuiding = options.photonGuiding;
    const Workers workers(2);
    const auto found =
        s.photons->pass({traced, &traced->scene().lights, passOptions}, pass, 0.1f, workers);
    PhotonQuery query;
    query.position = at;
    query.normal = query.shadingNormal = Vec3(0, 0, 1);
    query.radius = 0.8f;
    return found->map.gather(query).count;
}

} // namespace

TEST_CASE("photon guiding: the same light with and without", "[photons][statistics]")
{
    // The test has eight means and four comparisons within 4 standard errors: a false alarm has a
    // probability of 6e-4 in all.
    for (const Lit lit : {ByLamp, BySun, ByMany})
    {
        const auto traced = litHall(lit).build(2);
        for (const IntegratorKind kind : {IntegratorKind::PhotonCaustics, IntegratorKind::Sppm})
        {
            // One hall is enough for SPPM.
            if (kind == IntegratorKind::Sppm && lit != ByMany) continue;
            Estimate means[2];
            for (const bool guided : {false, true})
                for (uint32_t seed = 0; seed < 16; ++seed)
                {
                    RenderOptions options = guidingOptions(kind, guided);
                    options.seed = seed + 100 * guided;
                    const Picture picture = render(traced, viewOfOne(), options, 10);
                    REQUIRE(picture.progress.droppedSamples == 0);
                    means[guided].add(double(luminance(picture.mean())));
                }
            const double spread = std::hypot(means[0].standardError(), means[1].standardError());
            CAPTURE(int(lit), int(kind), means[0].mean(), means[0].standardError(), means[1].mean(),
                    means[1].standardError());
            CHECK(means[0].mean() > 0.02);
            CHECK(spread < 0.02 * means[0].mean());
            CHECK(std::abs(means[0].mean() - means[1].mean()) <= 4.0 * spread);
        }
    }
}

TEST_CASE("photon guiding: several times as many photons land where one ball of many is seen",
          "[photons]")
{
    for (const Lit lit : {ByLamp, BySun, ByMany})
    {
        CAPTURE(int(lit));
        const auto traced = litHall(lit).build(2);
        uint32_t counts[2] = {};
        for (const bool guided : {false, true})
        {
            const RenderOptions options = guidingOptions(IntegratorKind::PhotonCaustics, guided);
            SharedSession s(traced, options, viewOfOne());
            s.upTo(5);
            for (int pass = 5; pass < 9; ++pass)
                counts[guided] += photonsAround(s, traced, options, pass, kSeen);
        }
        CAPTURE(counts[0], counts[1]);
        CHECK(counts[0] > 50);
        CHECK(counts[1] > 8 * counts[0]);
    }
}

TEST_CASE("photon guiding: equal for any number of threads, and of views that come again",
          "[photons][stability 50]")
{
    const auto traced = litHall(ByMany).build(2);
    for (const IntegratorKind kind :
         {IntegratorKind::Ppm, IntegratorKind::Sppm, IntegratorKind::PhotonCaustics})
    {
        CAPTURE(int(kind));
        const RenderOptions options = guidingOptions(kind, true);
        SharedSession one(traced, options, viewOfOne(), {}, 1);
        one.upTo(7);
        const std::vector<float> expected = one.session.resolveRadiance();
        SharedSession many(traced, options, viewOfOne(), {}, 5);
        many.upTo(7);
        CHECK(many.session.resolveRadiance() == expected);

        // The view moves away and comes back: what was learnt elsewhere is forgotten.
        many.session.setView(viewOfOne({-9, 0, 0}));
        many.upTo(7);
        CHECK(many.session.resolveRadiance() != expected);
        many.session.setView(viewOfOne());
        many.upTo(7);
        CHECK(many.session.resolveRadiance() == expected);
    }
}

TEST_CASE("photon guiding: the first passes and those without it are the same for all views",
          "[photons]")
{
    const auto traced = litHall(ByLamp).build(2);
    for (const bool guided : {false, true})
    {
        const RenderOptions options = guidingOptions(IntegratorKind::PhotonCaustics, guided);
        SharedSession here(traced, options, viewOfOne());
        SharedSession there(traced, options, viewOfOne({-9, 0, 0}));
        here.upTo(6);
        there.upTo(6);
        for (int pass = 0; pass < 6; ++pass)
        {
            CAPTURE(guided, pass);
            const bool same = photonsAround(here, traced, options, pass, kSeen) ==
                              photonsAround(there, traced, options, pass, kSeen);
            CHECK(same == (!guided || pass < PhotonPasses::kFirst));
        }
    }
}

TEST_CASE("photon guiding: two views of a scene get photons both, from the same passes",
          "[photons]")
{
    const auto traced = litHall(BySun).build(2);
    const RenderOptions options = guidingOptions(IntegratorKind::PhotonCaustics, true);
    const Vec3 other(-9, 0, 0);
    const auto photons = std::make_shared<PhotonPasses>();
    SharedSession left(traced, options, viewOfOne(), photons);
    const uint32_t before = photonsAround(left, traced, options, 3, kSeen);
    {
        SharedSession right(traced, options, viewOfOne(other), photons);
        for (int pass = 1; pass <= 4; ++pass)
        {
            left.upTo(pass);
            right.upTo(pass);
        }
        left.upTo(5); // guided by the records of left, later passes by those of both views
        right.upTo(5);
        left.upTo(6);
        const uint64_t rays = photons->tracedRays();
        right.upTo(6);
        CHECK(photons->tracedRays() == rays);
        CHECK(photonsAround(left, traced, options, 5, kSeen) > 4 * before);
        CHECK(photonsAround(left, traced, options, 5, other) > 4 * before);
    }
    // The right view is gone, and so are its records.
    left.upTo(7);
    CHECK(photonsAround(left, traced, options, 6, kSeen) > 8 * before);
    CHECK(photonsAround(left, traced, options, 6, other) < 2 * before);
}
