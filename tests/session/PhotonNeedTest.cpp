// PhotonNeedTest.cpp - AUTOMATIC leaves the light of brushed metal to paths if none of it is seen.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kLearning = 4; ///< passes after which the choice is made

Material brushed()
{
    Material material = mirror(Vec3(0.95f, 0.9f, 0.8f));
    material.roughness = 0.3f;
    return material;
}

/// Returns two places of a floor, a wall and a lamp. One of them has a brushed block.
std::shared_ptr<const TracedScene> twoPlaces(float roughWall = 1.0f)
{
    SceneBuilder builder;
    for (const float x : {0.0f, 50.0f})
    {
        builder.add(quadMesh({x - 2, -2, 0}, {4, 0, 0}, {0, 4, 0}), lambert(Vec3(0.6f)));
        Material wall = lambert(Vec3(0.7f, 0.5f, 0.3f));
        if (roughWall < 1.0f) wall = mirror(Vec3(0.5f));
        wall.roughness = roughWall;
        builder.add(quadMesh({x - 2, -2, 0}, {0, 4, 0}, {0, 0, 3}), wall);
        builder.addQuadLight({x - 0.3f, -1.8f, 2.5f}, {0, 0.6f, 0}, {0.6f, 0, 0}, Vec3(30.0f));
    }
    builder.add(boxMesh({49.3f, 0.1f, 0}, {50.1f, 0.6f, 0.9f}), brushed());
    return builder.build();
}

View viewOf(float x)
{
    return perspectiveView({x + 2, -4, 2}, {x, 0, 0.4}, {0, 0, 1}, 40.0, 48, 32);
}

struct Rendered
{
    std::vector<float> image;
    uint64_t photonRays;
    PhotonNote note;
    uint64_t storedPhotons;

    bool operator==(const Rendered& other) const
    {
        return image == other.image && photonRays == other.photonRays;
    }
};

/// Renders passes from first on.
Rendered rendered(const std::shared_ptr<const TracedScene>& traced, float x, IntegratorKind kind,
                  int first, int passes, int threads = 2)
{
    RenderOptions options = optionsOf(kind, 4);
    options.photons = 4000;
    RenderSession session(std::make_shared<Workers>(threads));
    session.setScene(traced);
    session.setView(viewOf(x));
    session.setOptions(options);
    session.setFirstPass(first);
    StopRule rule;
    rule.passes = first + passes;
    const RenderProgress progress = session.render(rule);
    REQUIRE(progress.passes == passes);
    return {session.resolveRadiance(), progress.rays.photon, progress.photonNote,
            progress.storedPhotons};
}

} // namespace

TEST_CASE("photon need: where no light of metal is seen, paths find all of it", "[session]")
{
    const auto traced = twoPlaces();
    const Rendered chosen = rendered(traced, 0.0f, IntegratorKind::Automatic, kLearning, 2);
    const Rendered asked = rendered(traced, 0.0f, IntegratorKind::PhotonCaustics, kLearning, 2);
    CHECK((chosen.image == rendered(traced, 0.0f, IntegratorKind::Path, kLearning, 2).image));
    CHECK(chosen.photonRays > 0); // of the passes that tell
    CHECK(asked.photonRays > chosen.photonRays);
    CHECK(chosen.note == PhotonNote::Ended);
    CHECK(chosen.storedPhotons == 0);
    CHECK(asked.note == PhotonNote::None);
    CHECK(asked.storedPhotons > 0);
    const Rendered learning = rendered(traced, 0.0f, IntegratorKind::Automatic, 0, kLearning);
    CHECK(learning.note == PhotonNote::None); // all of its passes have photons
}

TEST_CASE("photon need: where it is seen, photons carry it", "[session]")
{
    const auto traced = twoPlaces();
    const Rendered chosen = rendered(traced, 50.0f, IntegratorKind::Automatic, kLearning, 2);
    CHECK((chosen == rendered(traced, 50.0f, IntegratorKind::PhotonCaustics, kLearning, 2)));
    CHECK((chosen.image != rendered(traced, 50.0f, IntegratorKind::Path, kLearning, 2).image));
}

TEST_CASE("photon need: mirrors keep their photons, as paths cannot find all of their light",
          "[session]")
{
    const auto traced = twoPlaces(0.0f);
    CHECK((rendered(traced, 0.0f, IntegratorKind::Automatic, kLearning, 2) ==
           rendered(traced, 0.0f, IntegratorKind::PhotonCaustics, kLearning, 2)));
}

TEST_CASE("photon need: the choice depends neither on threads nor on where passes are made",
          "[session]")
{
    const auto traced = twoPlaces();
    CHECK((rendered(traced, 0.0f, IntegratorKind::Automatic, 0, 7, 1) ==
           rendered(traced, 0.0f, IntegratorKind::Automatic, 0, 7, 3)));
    RenderOptions options = optionsOf(IntegratorKind::Automatic, 4);
    options.photons = 4000;
    const Rendered later = rendered(traced, 0.0f, IntegratorKind::Automatic, 6, 1);
    RenderSession session(std::make_shared<Workers>(1));
    session.setScene(traced);
    session.setView(viewOf(0.0f));
    session.setOptions(options);
    int next = 0;
    StopRule rule; // all passes before are made first; the film gets the seventh alone
    rule.nextPass = [&] { return next++ == 0 ? 6 : -1; };
    CHECK(session.render(rule).passes == 1);
    CHECK((session.resolveRadiance() == later.image));
}
