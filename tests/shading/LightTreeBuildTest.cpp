// LightTreeBuildTest.cpp - light trees that several threads build or refit, and lights of a range.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"

#include <cstring>
#include <functional>
#include <memory>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns two shining spheres of some 12,000 triangles together, and a few other lights, so that
/// some leaves are next to the root and subtrees are of very unequal size.
SceneBuilder shining(Vec3 offset)
{
    SceneBuilder builder;
    builder.addEmissive(sphereMesh(Vec3(3, 3, 3) + offset, 0.5f, 70), lamp(Vec3(0.5f)));
    builder.addEmissive(sphereMesh(Vec3(-9, 1, 2), 0.1f, 30), lamp(Vec3(0.1f)));
    builder.addQuadLight(Vec3(500, 0, 0), {1, 0, 0}, {0, 1, 0}, Vec3(1.0f));
    Light point = pointLight(Vec3(0, -500, 0), Vec3(1.0f));
    builder.addLight(point);
    return builder;
}

Vec3 placeOf(const LightEmitter& e)
{
    return Vec3(e.corner[0], e.corner[1], e.corner[2]);
}

struct Asked
{
    Vec3 p, normal;
    float u;
};

std::vector<Asked> randomPoints(int count)
{
    Uniform random(21);
    std::vector<Asked> asked;
    for (int i = 0; i < count; ++i)
    {
        const Vec3 p(random.between(-9, 9), random.between(-9, 9), random.between(-1, 9));
        const Vec3 normal(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
        asked.push_back({p, glm::normalize(normal), random()});
    }
    return asked;
}

/// Returns how many of the emitters, ways and choices of two trees differ in any bit.
int differences(const SceneLightTree& a, const SceneLightTree& b, const std::vector<Asked>& points)
{
    int different = a.top()->spread() != b.top()->spread() ||
                    a.top()->spreadAtBuild() != b.top()->spreadAtBuild();
    for (uint32_t k = 0; k < a.size(); ++k)
    {
        const LightEmitter x = a.emitter(k), y = b.emitter(k);
        different += std::memcmp(&x, &y, sizeof(LightEmitter)) != 0;
        different += a.top()->numberOf(k) != b.top()->numberOf(k);
    }
    for (const Asked& at : points)
    {
        const SceneLightTree::Choice x = a.choose(at.p, at.normal, at.u),
                                     y = b.choose(at.p, at.normal, at.u);
        different += x.emitter != y.emitter || x.pmf != y.pmf;
        for (uint32_t k = 0; k < a.size(); k += 97)
            different += a.pmf(at.p, at.normal, k) != b.pmf(at.p, at.normal, k);
    }
    return different;
}

/// Returns a square of side 0.1 that shines to the side of cross(u, v).
LightEmitter square(Vec3 centre, Vec3 u, Vec3 v)
{
    const Vec3 corner = centre - 0.05f * (u + v);
    LightEmitter e{};
    for (int c = 0; c < 3; ++c)
    {
        e.corner[c] = corner[c];
        e.edgeU[c] = 0.1f * u[c];
        e.edgeV[c] = 0.1f * v[c];
        e.radiance[c] = 1.0f;
    }
    e.area = 0.01f;
    return e;
}

/// Returns the index of the first emitter of the root's second node; there must be two on each
/// side.
uint32_t rootSplit(const LightEmitters& emitters)
{
    return lightPairs(emitters, nullptr).children[1];
}

} // namespace

TEST_CASE("light tree: the root parts lights by place, by direction and by power", "[shading]")
{
    constexpr Vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    // As many in each of the twelve bins of the build; 6,000 are parted across one axis alone.
    const uint32_t count = GENERATE(120u, 6000u), third = count / 3;
    const int axis = GENERATE(0, 1, 2);
    CAPTURE(count, axis);
    LightEmitters row(count);
    const auto set = [&](float gap, Vec3 u, Vec3 v, float power)
    {
        for (uint32_t k = 0; k < count; ++k)
        {
            const bool first = k < third;
            Vec3 at(0.0f);
            at[axis] =
                static_cast<float>(k) * 120.0f / static_cast<float>(count) + (first ? 0.0f : gap);
            row[k] = first ? square(at, x, y) : square(at, u, v);
            row[k].area *= first ? power : 1.0f;
        }
    };
    set(0.0f, x, y, 1.0f);
    CHECK(rootSplit(row) == count / 2);
    set(1000.0f, x, y, 1.0f);
    CHECK(rootSplit(row) == third);
    set(0.0f, y, x, 1.0f);
    CHECK(rootSplit(row) == third);
    set(0.0f, y, z, 1.0f);
    CHECK(rootSplit(row) == third);
    set(0.0f, x, y, 1000.0f);
    CHECK(rootSplit(row) == third);
}

TEST_CASE("light tree: the same for any number of threads, built and refitted", "[shading]")
{
    const SceneBuilder builder = shining(Vec3(0.0f)), moved = shining(Vec3(0.2f, 0.1f, 0.0f));
    const std::vector<Asked> points = randomPoints(200);
    const LightTable alone(*builder.scene), movedAlone(*moved.scene, &alone);
    REQUIRE(alone.tree()->size() > 10000);
    CHECK(differences(*alone.tree(), *movedAlone.tree(), points) > 1000);
    for (const int threads : {1, 2, 16})
    {
        const Workers workers(threads);
        const LightTable table(*builder.scene, nullptr, nullptr, &workers);
        const LightTable refitted(*moved.scene, &table, nullptr, &workers);
        CAPTURE(threads);
        CHECK(differences(*alone.tree(), *table.tree(), points) == 0);
        CHECK(differences(*movedAlone.tree(), *refitted.tree(), points) == 0);
        // What paths meet by chance is what the tree holds.
        int wrong = 0;
        for (uint32_t k = 0; k < table.tree()->size(); ++k)
        {
            const LightEmitter e = refitted.tree()->emitter(k);
            wrong += !e.isPoint() && refitted.emitterOf(e.light, e.primitive) != k;
        }
        CHECK(wrong == 0);
    }
}

TEST_CASE("light tree: it is kept if something else changes, and not if a light does", "[shading]")
{
    const SceneBuilder builder = shining(Vec3(0.0f));
    const LightTable table(*builder.scene);
    const auto keeps = [&](const std::function<void(Scene&)>& change)
    {
        Scene edited = *builder.scene;
        change(edited);
        return LightTable(edited, &table).tree() == table.tree();
    };
    CHECK(keeps([](Scene&) {}));
    CHECK(keeps([](Scene& scene) { scene.materials.emplace_back(); }));
    CHECK_FALSE(keeps([](Scene& scene) { scene.lights[0].radiance *= 2.0f; }));
    CHECK_FALSE(keeps([](Scene& scene) { scene.lights[2].corner.z += 1.0f; }));
    CHECK_FALSE(keeps([](Scene& scene) { scene.lights[3].position.z += 1.0f; }));
    CHECK_FALSE(keeps([](Scene& scene) { std::swap(scene.meshes[0], scene.meshes[1]); }));
    CHECK_FALSE(keeps([](Scene& scene) { scene.instances[1].placed = true; }));
    CHECK_FALSE(keeps([](Scene& scene) { scene.lights.pop_back(); }));
}

TEST_CASE("light tree: a mesh that deforms in each frame uses its memory again", "[shading]")
{
    const SceneBuilder scenes[] = {shining(Vec3(0.0f)), shining(Vec3(0.2f, 0.1f, 0.0f))};
    const std::vector<Asked> points = randomPoints(20);
    const LightTable first(*scenes[0].scene), second(*scenes[1].scene, &first);
    const LightTable* const expected[] = {&first, &second};
    auto now = std::make_unique<const LightTable>(*scenes[0].scene);
    for (int frame = 1; frame < 6; ++frame)
    {
        now = std::make_unique<const LightTable>(*scenes[frame % 2].scene, now.get());
        CHECK(differences(*now->tree(), *expected[frame % 2]->tree(), points) == 0);
    }

    SpareLightArrays spare;
    LightArrays arrays = spare.take(10);
    CHECK(arrays.nodes.size() == 18);
    const LightEmitter* const kept = arrays.emitters.data();
    spare.give(std::move(arrays));
    const LightEmitters beside(10); // where the arrays were if they had been freed
    arrays = spare.take(10);
    CHECK(beside.data() != kept);
    CHECK(arrays.emitters.data() == kept);
    spare.give(std::move(arrays));
    CHECK(spare.take(11).emitters.size() == 11);
}

TEST_CASE("light tree: the probabilities of a large tree sum to 1", "[shading]")
{
    const SceneBuilder builder = shining(Vec3(0.0f));
    const Workers workers(2);
    const LightTable table(*builder.scene, nullptr, nullptr, &workers);
    const SceneLightTree& tree = *table.tree();
    for (const Asked& at : randomPoints(20))
    {
        double sum = 0.0;
        for (uint32_t k = 0; k < tree.size(); ++k)
            sum += tree.pmf(at.p, at.normal, k);
        CHECK(sum == Approx(1.0).epsilon(1e-5));
    }
}

TEST_CASE("light tree: lights that are out of their range cost no samples", "[shading]")
{
    // Lamps of range 2 stand 1 apart along x, so that few of them are in range. Nodes are bounded
    // by spheres: now and then one is chosen though none of its lamps is in range.
    SceneBuilder builder;
    for (int i = 0; i < 100; ++i)
    {
        Light light = pointLight(Vec3(static_cast<float>(i), 0.0f, 1.0f), Vec3(1.0f));
        light.range = 2.0f;
        builder.addLight(light);
    }
    const LightTable table(*builder.scene);
    Uniform random(22);
    constexpr int kPoints = 500;
    double inRange = 0.0;
    for (int i = 0; i < kPoints; ++i)
    {
        const Vec3 p(random.between(5, 95), 0.0f, 0.0f);
        for (uint32_t k = 0; k < table.tree()->size(); ++k)
        {
            const float pmf = table.tree()->pmf(p, Vec3(0, 0, 1), k);
            const float distance = glm::length(placeOf(table.tree()->emitter(k)) - p);
            if (distance < 2.0f) inRange += pmf / kPoints;
            if (distance < 1.999f) CHECK(pmf > 0.0f);
        }
    }
    CHECK(inRange > 0.97);
}
