// SceneDigestTest.cpp - the digest sees all that images depend on, and nothing else.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/scene/SceneEdits.h"

#include "osgRayTrace/scene/SceneDigest.h"

#include <set>
#include <vector>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

TEST_CASE("digest: each value that images depend on counts", "[scene]")
{
    std::set<uint64_t> digests{sceneDigest(someScene())};
    const std::vector<Edit> all = edits();
    for (std::size_t i = 0; i < all.size(); ++i)
    {
        CAPTURE(i);
        Scene scene = someScene();
        all[i](scene);
        CHECK(digests.insert(sceneDigest(scene)).second);
    }
}

TEST_CASE("digest: names, stamps and addresses do not count", "[scene]")
{
    Scene scene = someScene();
    const uint64_t before = sceneDigest(scene);
    scene.changed = 7;
    scene.materials[0].name = "other";
    scene.materials[0].changed = 8;
    scene.lights[0].name = "other";
    ofMesh(
        [](Mesh& mesh)
        {
            mesh.name = "other";
            mesh.changed = 9;
            mesh.positions =
                std::vector<Vec3>(mesh.positions.begin(), mesh.positions.end()); // a copy
        })(scene);
    ofTexture([](Texture& texture) { texture.name = "other"; })(scene);
    CHECK(sceneDigest(scene) == before);
}
