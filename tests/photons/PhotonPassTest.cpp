// PhotonPassTest.cpp - what is computed again in each pass and after each change, and what is kept.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"

#include "osgRayTrace/photons/PhotonPasses.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kSize = 40; // tiles at the border are cut

/// Returns a smooth-shaded ball of few facets: rays that leave it have a terminator offset.
std::shared_ptr<Mesh> smoothBall(Vec3 centre, float radius)
{
    auto mesh = sphereMesh(centre, radius, 8);
    std::vector<Vec3> normals;
    for (const Vec3& position : mesh->positions)
        normals.push_back(glm::normalize(position - centre));
    mesh->normals = std::move(normals);
    return mesh;
}

/// Returns a room with every kind of hit point: diffuse, coated, glossy, mirror, clear and rough
/// glass, and light of all kinds.
SceneBuilder room(float ballX, const Material& ball = glass(1.5f))
{
    SceneBuilder builder;
    Material coated = lambert(Vec3(0.6f, 0.5f, 0.4f));
    coated.ior = 1.5f;
    coated.roughness = 0.1f;
    Material glossy = mirror(Vec3(0.9f, 0.8f, 0.7f));
    glossy.roughness = 0.3f;
    builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), coated);
    builder.add(quadMesh({-1, 1, 0}, {2, 0, 0}, {0, 0, 2}), lambert(Vec3(0.6f, 0.3f, 0.3f)));
    builder.add(quadMesh({-1, 1, 0}, {0, -2, 0}, {0, 0, 2}), glossy);
    builder.add(sphereMesh({ballX, 0.1f, 0.4f}, 0.3f, 16), ball);
    builder.add(sphereMesh({0.6f, -0.2f, 0.3f}, 0.25f, 16), glass(1.5f, 0.6f));
    builder.add(boxMesh({-0.8f, -0.5f, 0.0f}, {-0.5f, -0.2f, 0.3f}), mirror(Vec3(0.9f)));
    builder.add(smoothBall({-0.1f, -0.6f, 0.3f}, 0.25f), lambert(Vec3(0.5f)));
    builder.add(smoothBall({0.5f, -0.7f, 0.2f}, 0.15f), coated);
    builder.addQuadLight({-0.8f, -0.8f, 2.0f}, {0, 1.6f, 0}, {1.6f, 0, 0}, Vec3(2.0f));
    builder.addQuadLight({0.5f, -0.8f, 1.5f}, {0, 0.2f, 0}, {0.2f, 0, 0}, Vec3(9.0f));
    builder.addLight(pointLight({0.5f, -0.5f, 1.5f}, Vec3(0.2f)));
    return builder;
}

View viewFrom(double x)
{
    return perspectiveView({x, -3, 1.6}, {0, 0.1, 0.45}, {0, 0, 1}, 38.0, kSize, kSize);
}

RenderOptions photonOptions(IntegratorKind kind)
{
    RenderOptions options = optionsOf(kind, 6);
    options.photons = 5000;
    options.photonRadius = 0.1f;
    return options;
}

struct Session
{
    std::shared_ptr<PhotonPasses> photons = std::make_shared<PhotonPasses>();
    RenderSession session{std::make_shared<Workers>(2), photons};

    RenderProgress passes(int count)
    {
        StopRule rule;
        rule.newPasses = count;
        return session.render(rule);
    }
};

} // namespace

TEST_CASE("photon passes: PPM follows new camera paths in every second pass of a half", "[photons]")
{
    Session s;
    s.session.setScene(room(-0.1f).build());
    s.session.setView(viewFrom(0.5));
    s.session.setOptions(photonOptions(IntegratorKind::Ppm));
    const RenderProgress first = s.passes(1);
    CHECK(first.rays.camera >= uint64_t(kSize) * kSize);
    CHECK(first.rays.secondary > 0);
    CHECK(first.hitPointBytes > uint64_t(kSize) * kSize * 100);
    CHECK(first.hitPointBytes < uint64_t(kSize) * kSize * 1000);
    const RenderProgress halves = s.passes(1);
    CHECK(halves.rays.camera == 2 * first.rays.camera);
    CHECK(halves.rays.secondary > first.rays.secondary);
    CHECK(halves.hitPointBytes > 1.8 * double(first.hitPointBytes));

    // The next pass of each half gathers at the same points.
    const RenderProgress again = s.passes(2);
    CHECK(again.rays.camera == halves.rays.camera);
    CHECK(again.rays.secondary == halves.rays.secondary);
    CHECK(again.rays.shadow > 1.9 * double(halves.rays.shadow));
    CHECK(again.rays.photon > 1.9 * double(halves.rays.photon));
    CHECK(again.hitPointBytes == halves.hitPointBytes);

    const RenderProgress others = s.passes(2);
    CHECK(others.rays.camera == 4 * first.rays.camera);
    CHECK(others.rays.secondary > again.rays.secondary);
    CHECK(double(others.hitPointBytes) == Approx(double(again.hitPointBytes)).epsilon(0.1));
    CHECK(s.passes(2).rays.camera == others.rays.camera);
}

TEST_CASE("photon passes: PPM antialiases, and its camera paths fill the pixels evenly",
          "[photons]")
{
    // The edge of a lamp makes 0.3 of a row of pixels bright; paths without antialiasing would give
    // 0 or 1.
    SceneBuilder builder;
    builder.addQuadLight({-20, -20, 0}, {20.3f, 0, 0}, {0, 40, 0}, Vec3(1.0f));
    builder.add(quadMesh({-20, -20, -1}, {40, 0, 0}, {0, 40, 0}), lambert(Vec3(0.0f)));
    Session s;
    s.session.setScene(builder.build());
    s.session.setView(patchView({0, 0, 0}, {0, 0, 1}, 16.0, 16));
    RenderOptions options = optionsOf(IntegratorKind::Ppm, 1);
    options.photons = 16;
    s.session.setOptions(options);
    s.passes(4);
    CHECK(s.session.estimateError().relative > 0.05);
    s.passes(124);
    const std::vector<float> image = s.session.resolveRadiance();
    for (std::size_t x = 0; x < 16; ++x) // the scene's +x is up
    {
        double bright = 0.0;
        for (std::size_t y = 0; y < 16; ++y)
            bright += double(image[4 * (16 * y + x)]);
        CHECK(bright ==
              Approx(8.3).margin(0.05)); // 2 x 32 paths, of which a half may miss one or two
    }
}

TEST_CASE("photon passes: kept hit points gather what paths do", "[photons]")
{
    // In the first pass both integrators follow the same paths: SPPM keeps nothing. With the global
    // schedule SPPM goes both ways at clear glass, and PPM does not.
    for (const RadiusSchedule schedule : {RadiusSchedule::Global, RadiusSchedule::Local})
    {
        const Material ball =
            schedule == RadiusSchedule::Local ? glass(1.5f) : mirror(Vec3(0.8f, 0.9f, 0.9f));
        const auto traced = room(-0.1f, ball).build();
        RenderOptions options = photonOptions(IntegratorKind::Ppm);
        options.radiusSchedule = schedule;
        const Picture kept = render(traced, viewFrom(0.5), options, 1);
        options.integrator = IntegratorKind::Sppm;
        const Picture followed = render(traced, viewFrom(0.5), options, 1);
        REQUIRE(kept.rgba.size() == followed.rgba.size());
        CHECK(followed.progress.hitPointBytes < kept.progress.hitPointBytes);
        // Mirrors and smooth glass have no hit points, and so none of their useless shadow rays.
        CHECK(kept.progress.rays.shadow < followed.progress.rays.shadow);
        int lit = 0;
        for (std::size_t k = 0; k < kept.rgba.size(); ++k)
        {
            REQUIRE(kept.rgba[k] == Approx(followed.rgba[k]).epsilon(1e-5).margin(1e-6));
            lit += kept.rgba[k] > 0.01f;
        }
        CHECK(lit > kSize * kSize);
    }
}

TEST_CASE("photon passes: a moved camera keeps them, a moved object does not", "[photons]")
{
    for (const IntegratorKind kind :
         {IntegratorKind::Ppm, IntegratorKind::Sppm, IntegratorKind::PhotonCaustics})
    {
        CAPTURE(int(kind));
        Session s;
        s.session.setScene(room(-0.1f).build());
        s.session.setView(viewFrom(0.5));
        s.session.setOptions(photonOptions(kind));
        s.passes(20);
        const uint64_t traced = s.photons->tracedRays();
        CHECK(traced > 20u * 5000u);

        // The view moves as with a head: each place gets a few passes.
        for (const double x : {0.6, 0.7, 0.8})
        {
            s.session.setView(viewFrom(x));
            const RenderProgress moved = s.passes(3);
            CHECK(moved.restarted);
            CHECK(moved.passes == 3);
            CHECK(moved.rays.camera >= uint64_t(kSize) * kSize);
            CHECK(moved.rays.photon > 0);
        }
        CHECK(s.photons->tracedRays() == traced);

        // The view comes back: the picture equals the first one.
        s.session.setView(viewFrom(0.5));
        s.passes(3);
        CHECK(s.photons->tracedRays() == traced);
        CHECK(s.session.resolveRadiance() ==
              render(room(-0.1f).build(), viewFrom(0.5), photonOptions(kind), 3).rgba);

        s.session.setScene(room(0.0f).build());
        CHECK(s.passes(1).restarted);
        CHECK(s.photons->tracedRays() > traced);
    }
}

TEST_CASE("photon passes: eyes that take turns share all of them, guided ones, too", "[photons]")
{
    const auto traced = room(-0.1f).build();
    const auto raysOf = [&](const std::vector<double>& eyes)
    {
        const auto photons = std::make_shared<PhotonPasses>();
        const auto workers = std::make_shared<Workers>(2);
        std::vector<std::unique_ptr<RenderSession>> sessions;
        for (const double x : eyes)
        {
            sessions.push_back(std::make_unique<RenderSession>(workers, photons));
            sessions.back()->setScene(traced);
            sessions.back()->setView(viewFrom(x));
            sessions.back()->setOptions(photonOptions(IntegratorKind::Sppm));
        }
        StopRule rule;
        rule.newPasses = 1;
        for (int pass = 0; pass < 8; ++pass)
            for (const auto& session : sessions)
                REQUIRE(session->render(rule).passes == pass + 1);
        return double(photons->tracedRays());
    };
    // A pass that was traced twice would add an eighth; other guides add or remove some rays.
    CHECK(raysOf({0.5, 0.51}) == Approx(raysOf({0.5})).epsilon(0.05));
}

TEST_CASE("photon passes: memory of kept passes is bounded", "[photons]")
{
    Session s;
    s.session.setScene(room(-0.1f).build());
    s.session.setView(viewFrom(0.5));
    s.session.setOptions(photonOptions(IntegratorKind::Sppm));
    const RenderProgress first = s.passes(1);
    const RenderProgress some = s.passes(7);
    const RenderProgress many = s.passes(12);
    CHECK(first.photonBytes > 40 * first.storedPhotons);
    // Six more maps; blocks of photons in their making are counted once.
    CHECK(some.photonBytes > first.photonBytes + 6 * 40 * first.storedPhotons);
    // Four of the first passes and four of the last ones are kept, and the memory for one more;
    // each pass stores about as many photons. Memory that is used again may be a sixteenth larger,
    // and the blocks of photons are half as large as a map.
    CHECK(many.photonBytes > some.photonBytes);
    CHECK(many.photonBytes < 1.2 * double(some.photonBytes));
}
