// MeshLightTreeTest.cpp - large placed meshes with light trees of their own: probabilities through
// both levels, moves, meshes that deform, and what instances share.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"
#include "tests/shading/TwoPicks.h"

#include <cstring>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

Affine turned(float angle, float scale, Vec3 translation, bool mirrored = false)
{
    const Vec3 axis = glm::normalize(Vec3(0.3f, -0.8f, 0.5f));
    Affine place;
    place.linear = Mat3(glm::rotate(glm::mat4(1.0f), angle, axis)) * scale;
    if (mirrored) place.linear[0] = -place.linear[0];
    place.translation = translation;
    return place;
}

struct Places
{
    Affine first = turned(0.7f, 2.0f, Vec3(3, 3, 3));
    Affine second = turned(2.1f, 0.5f, Vec3(-6, 2, 1), true);
};

/// Returns two instances of a shining half sphere with trees of their own, and lights beside them:
/// a mesh that is not placed, parallelograms, a point light.
SceneBuilder shining(const std::shared_ptr<const Mesh>& mesh, const Places& places,
                     Vec3 radiance = Vec3(0.5f))
{
    SceneBuilder builder;
    builder.addEmissive(sphereMesh(Vec3(-9, 1, 2), 0.1f, 8), lamp(Vec3(0.1f)));
    for (const Affine* place : {&places.first, &places.second})
    {
        Instance& instance = builder.scene->instances[builder.addEmissive(mesh, lamp(radiance))];
        instance.placed = true;
        instance.engineFromLocal = *place;
    }
    builder.addQuadLight(Vec3(5, 0, 0), {1, 0, 0}, {0, 1, 0}, Vec3(1.0f));
    builder.addQuadLight(Vec3(-5, 0, 5), {0, 1, 0}, {1, 0, 0}, Vec3(1.0f));
    builder.addLight(pointLight(Vec3(0, -5, 0), Vec3(0.2f)));
    return builder;
}

/// Returns the upper half of a sphere, so that normals are in a cone. bulge: stretches it along z.
std::shared_ptr<Mesh> halfSphere(float bulge = 1.0f)
{
    const auto whole = sphereMesh(Vec3(0.0f), 0.5f, 30);
    std::vector<Vec3> positions(whole->positions.begin(), whole->positions.end());
    std::vector<UVec3> triangles;
    for (const UVec3& t : whole->triangles)
        if (positions[t.x].z + positions[t.y].z + positions[t.z].z > 0.0f) triangles.push_back(t);
    for (Vec3& p : positions)
        p.z *= bulge;
    return newMesh(positions, triangles);
}

struct Receiver
{
    Vec3 p, normal;
};

Receiver receiver(Uniform& random)
{
    const Vec3 normal(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    return {Vec3(random.between(-9, 9), random.between(-9, 9), random.between(-1, 9)),
            glm::normalize(normal)};
}

/// Returns how many emitters and probabilities of two trees differ in any bit.
int differences(const SceneLightTree& a, const SceneLightTree& b)
{
    int different = 0;
    Uniform random(31);
    for (uint32_t k = 0; k < a.size(); ++k)
    {
        const LightEmitter x = a.emitter(k), y = b.emitter(k);
        const Receiver at = receiver(random);
        different += std::memcmp(&x, &y, sizeof x) != 0;
        different += a.pmf(at.p, at.normal, k) != b.pmf(at.p, at.normal, k);
    }
    return different;
}

/// Returns the largest difference of a sum of probabilities from 1, at random points.
double worstSum(const SceneLightTree& tree, int points)
{
    Uniform random(32);
    double worst = 0.0;
    for (int i = 0; i < points; ++i)
    {
        const Receiver at = receiver(random);
        double sum = 0.0;
        for (uint32_t k = 0; k < tree.size(); ++k)
            sum += tree.pmf(at.p, at.normal, k);
        worst = std::max(worst, std::abs(sum - 1.0));
    }
    return worst;
}

} // namespace

TEST_CASE("mesh light tree: triangles are where the scene has them", "[shading]")
{
    const auto mesh = halfSphere();
    const SceneBuilder builder = shining(mesh, {});
    const LightTable table(*builder.scene);
    REQUIRE(table.ownTree(1));
    REQUIRE(table.ownTree(2));
    CHECK_FALSE(table.ownTree(0));
    CHECK(table.ownTree(1)->own == table.ownTree(2)->own);
    const SceneLightTree& tree = *table.tree();
    REQUIRE(tree.size() > 2 * mesh->triangles.size());
    CHECK(tree.leaves() < 300);
    int wrong = 0;
    double areas[2] = {0.0, 0.0};
    for (const uint32_t light : {1u, 2u})
        for (uint32_t t = 0; t < mesh->triangles.size(); ++t)
        {
            const uint32_t number = table.emitterOf(light, t);
            if (number == kInvalid) continue;
            const LightEmitter e = tree.emitter(number);
            const Instance& instance = builder.scene->instances[light];
            const Vec3 corner =
                transformPoint(instance.engineFromLocal, mesh->positions[mesh->triangles[t].x]);
            wrong += e.light != light || e.primitive != t || !(e.flags & kTriangle) ||
                     Vec3(e.corner[0], e.corner[1], e.corner[2]) != corner || e.radiance[0] != 0.5f;
            areas[light - 1] += e.area;
        }
    CHECK(wrong == 0);
    CHECK(areas[0] == Approx(table.area(1)).epsilon(1e-5));
    CHECK(areas[1] == Approx(table.area(2)).epsilon(1e-5));
    CHECK(areas[0] == Approx(16.0 * areas[1]).epsilon(1e-5));
    // All numbers are those of a triangle or of another light.
    for (uint32_t k = 0; k < tree.size(); ++k)
    {
        const LightEmitter e = tree.emitter(k);
        wrong += e.isMesh() || (!e.isPoint() && table.emitterOf(e.light, e.primitive) != k);
    }
    CHECK(wrong == 0);
}

TEST_CASE("mesh light tree: probabilities sum to 1, and choices have them",
          "[shading][statistics][long]")
{
    // Frequencies of sums over 64 emitters: 1 % of false alarms in all tests together (Sidak).
    constexpr int kPoints = 6, kDraws = 1 << 16, kGroup = 64;
    const double significance = sidak(0.01, 2 * kPoints);
    const SceneBuilder builder = shining(halfSphere(), {});
    const LightTable table(*builder.scene);
    const SceneLightTree& tree = *table.tree();
    CHECK(worstSum(tree, 200) < 2e-5);
    Uniform random(33);
    for (int k = 0; k < kPoints; ++k)
    {
        Receiver at = receiver(random);
        if (k % 3 == 0) at.normal = Vec3(0.0f);
        const std::size_t groups = (tree.size() + kGroup - 1) / kGroup;
        std::vector<double> single(groups), lanes(groups), expected(groups);
        for (uint32_t e = 0; e < tree.size(); ++e)
            expected[e / kGroup] += kDraws * double(tree.pmf(at.p, at.normal, e));
        // Only some of the lanes are at the point, as lanes may come to different meshes.
        Vec3Lanes p, normal;
        for (int i = 0; i < kLanes; ++i)
        {
            const Receiver other = receiver(random);
            setLane(p, i, i % 2 ? at.p : other.p);
            setLane(normal, i, i % 2 ? at.normal : other.normal);
        }
        for (int draw = 0; draw < 2 * kDraws; draw += kLanes)
        {
            const SceneLightTree::Pick pick = pickOf(tree, p, normal, draw / kLanes, random);
            const UintLanes& emitters = pick.emitters;
            const FloatLanes& pmf = pick.pmf;
            SceneLightTree::Gathered gathered;
            tree.gather(emitters, gathered);
            for (int i = 1; i < kLanes; i += 2)
            {
                const SceneLightTree::Choice choice = tree.choose(at.p, at.normal, random());
                ++lanes[emitters[i] / kGroup];
                ++single[choice.emitter / kGroup];
                const LightEmitter own = tree.emitter(emitters[i]);
                if (std::memcmp(&own, &gathered.of(i), sizeof own) != 0) FAIL("lane " << i);
                const float claimed = tree.pmf(at.p, at.normal, emitters[i]);
                if (!(std::abs(pmf[i] - claimed) <= 1e-4f * claimed)) FAIL("pmf of lane " << i);
                const float alone = tree.pmf(at.p, at.normal, choice.emitter);
                if (!(std::abs(choice.pmf - alone) <= 1e-4f * alone)) FAIL("pmf of a choice");
            }
        }
        CAPTURE(k);
        CHECK(chiSquareTest(single, expected) > significance);
        CHECK(chiSquareTest(lanes, expected) > significance);
    }
}

TEST_CASE("mesh light tree: no triangle whose light reaches a point has probability 0", "[shading]")
{
    const SceneBuilder builder = shining(halfSphere(), {});
    const LightTable table(*builder.scene);
    const SceneLightTree& tree = *table.tree();
    Uniform random(34);
    int lit = 0, dark = 0;
    for (int i = 0; i < 300; ++i)
    {
        const Receiver at = receiver(random);
        for (uint32_t e = 0; e < tree.size(); ++e)
        {
            const LightEmitter emitter = tree.emitter(e);
            if (!(emitter.flags & kTriangle)) continue;
            bool any = false;
            for (const Vec2 uv : {Vec2(0.01f), Vec2(0.98f, 0.01f), Vec2(0.01f, 0.98f)})
            {
                Vec3 q;
                for (int k = 0; k < 3; ++k)
                    q[k] = emitter.corner[k] + uv.x * emitter.edgeU[k] + uv.y * emitter.edgeV[k];
                any |= glm::dot(glm::normalize(q - at.p), at.normal) > 1e-3f;
            }
            ++(any ? lit : dark);
            if (any && !(tree.pmf(at.p, at.normal, e) > 0.0f))
                FAIL("emitter " << e << " at point " << i);
        }
    }
    CHECK(lit > 100000);
    CHECK(dark > 100000);
}

TEST_CASE("mesh light tree: a move keeps the tree of the mesh, and is that of a new table",
          "[shading]")
{
    const auto mesh = halfSphere();
    const SceneBuilder builder = shining(mesh, {});
    Places places;
    places.first = turned(0.9f, 2.0f, Vec3(3.5f, 3, 2));
    const SceneBuilder moved = shining(mesh, places);
    const LightTable alone(*builder.scene), fresh(*moved.scene);
    for (const int threads : {1, 2, 16})
    {
        const Workers workers(threads);
        const LightTable table(*builder.scene, nullptr, nullptr, &workers);
        const LightTable same(*builder.scene, &table, nullptr, &workers);
        const LightTable refitted(*moved.scene, &table, nullptr, &workers);
        CAPTURE(threads);
        CHECK(differences(*table.tree(), *alone.tree()) == 0);
        CHECK(same.tree() == table.tree());
        CHECK(refitted.ownTree(1)->own == table.ownTree(1)->own);
        CHECK(refitted.tree() != table.tree());
        CHECK(worstSum(*refitted.tree(), 50) < 2e-5);
        // The shape of the upper level may differ, the leaves and the emitters below may not.
        int wrong = 0;
        for (const uint32_t light : {1u, 2u})
            for (uint32_t t = 0; t < mesh->triangles.size(); ++t)
            {
                const uint32_t a = refitted.emitterOf(light, t), b = fresh.emitterOf(light, t);
                if (a == kInvalid && b == kInvalid) continue;
                const LightEmitter x = refitted.tree()->emitter(a), y = fresh.tree()->emitter(b);
                wrong += std::memcmp(&x, &y, sizeof x) != 0;
            }
        CHECK(wrong == 0);
        CHECK(refitted.area(1) == fresh.area(1));
        CHECK(refitted.pointOffset(1) == fresh.pointOffset(1));
    }
    // Light that is brighter takes more samples with the same tree of the mesh.
    const SceneBuilder brighter = shining(mesh, {}, Vec3(5.0f));
    const LightTable bright(*brighter.scene, &alone);
    CHECK(bright.ownTree(1)->own == alone.ownTree(1)->own);
    const auto share = [](const LightTable& table)
    {
        float sum = 0.0f;
        for (uint32_t t = 0; t < 1000; ++t)
            if (const uint32_t number = table.emitterOf(2, t); number != kInvalid)
                sum += table.tree()->pmf(Vec3(-6, -2, 0), Vec3(0, 0, 1), number);
        return sum;
    };
    CHECK(share(bright) > 1.1f * share(alone));
}

namespace
{

/// Returns what a point gets from the middle of a triangle of radiance 1.
double irradiance(const LightEmitter& e, const Receiver& at)
{
    const auto vectorOf = [](const float(&w)[3]) { return Vec3d(w[0], w[1], w[2]); };
    const Vec3d u = vectorOf(e.edgeU), v = vectorOf(e.edgeV);
    const Vec3d d = vectorOf(e.corner) + (u + v) / 3.0 - Vec3d(at.p);
    const double distance2 = glm::dot(d, d);
    return 0.5 * std::abs(glm::dot(glm::cross(u, v), d)) *
           std::max(glm::dot(d, Vec3d(at.normal)), 0.0) / (distance2 * distance2);
}

/// How the choices among the triangles of a placed mesh, which is alone in its scene, compare with
/// those of a tree over its triangles in the scene.
struct Comparison
{
    double distance = 0.0; ///< mean over points of the sum of differences of probabilities
    double own = 0.0;      ///< mean relative variance of an estimate of the irradiance
    double whole = 0.0;    ///< the same for the tree over triangles in the scene
};

Comparison compare(const std::shared_ptr<const Mesh>& mesh, const Affine& place)
{
    SceneBuilder builder, flat;
    Instance& instance = builder.scene->instances[builder.addEmissive(mesh, lamp(Vec3(1.0f)))];
    instance.placed = true;
    instance.engineFromLocal = place;
    std::vector<Vec3> positions;
    for (const Vec3& p : mesh->positions)
        positions.push_back(transformPoint(place, p));
    flat.addEmissive(
        newMesh(positions, std::vector<UVec3>(mesh->triangles.begin(), mesh->triangles.end())),
        lamp(Vec3(1.0f)));
    const LightTable own(*builder.scene), whole(*flat.scene);
    REQUIRE(own.ownTree(0));
    REQUIRE_FALSE(whole.ownTree(0));
    CHECK_FALSE(own.tree()->top());
    REQUIRE(own.tree()->size() == whole.tree()->size());
    CHECK(own.area(0) == Approx(whole.area(0)).epsilon(1e-6));
    CHECK(own.pointOffset(0) >= whole.pointOffset(0) * 0.999f);
    CHECK(own.pointOffset(0) < whole.pointOffset(0) * 3.0f);
    Uniform random(35);
    Comparison result;
    constexpr int kPoints = 200;
    for (int i = 0; i < kPoints; ++i)
    {
        const Receiver at = receiver(random);
        double sum = 0.0, ownSquares = 0.0, wholeSquares = 0.0;
        for (uint32_t t = 0; t < mesh->triangles.size(); ++t)
        {
            const uint32_t a = own.emitterOf(0, t), b = whole.emitterOf(0, t);
            if ((a == kInvalid) != (b == kInvalid)) FAIL("triangle " << t);
            if (a == kInvalid) continue;
            const double p = own.tree()->pmf(at.p, at.normal, a),
                         q = whole.tree()->pmf(at.p, at.normal, b),
                         f = irradiance(own.tree()->emitter(a), at);
            result.distance += std::abs(p - q) / kPoints;
            sum += f;
            ownSquares += f > 0.0 ? f * f / p : 0.0;
            wholeSquares += f > 0.0 ? f * f / q : 0.0;
        }
        if (!(sum > 0.0)) continue;
        result.own += (ownSquares / (sum * sum) - 1.0) / kPoints;
        result.whole += (wholeSquares / (sum * sum) - 1.0) / kPoints;
    }
    return result;
}

} // namespace

TEST_CASE("mesh light tree: choices are as good as those of a tree over triangles in the scene",
          "[shading][long]")
{
    // If boxes are along the same axes in both spaces, the trees have the same shape, up to planes
    // that rounding moves. If not, both bound the same lights a little differently.
    const auto mesh = halfSphere();
    CHECK(compare(mesh, {Mat3(2.0f), Vec3(1, 2, 3)}).distance < 0.02);
    for (const Affine& place : {Places().first, Places().second})
    {
        const Comparison turned = compare(mesh, place);
        CAPTURE(turned.distance, turned.own, turned.whole);
        CHECK(turned.own < 1.1 * turned.whole);
        CHECK(turned.own > 0.5 * turned.whole);
    }
}

TEST_CASE("mesh light tree: a mesh that deforms keeps the shape of its tree", "[shading]")
{
    const auto mesh = halfSphere();
    const SceneBuilder builder = shining(mesh, {});
    const SceneBuilder stretched = shining(halfSphere(1.2f), {});
    const LightTable table(*builder.scene), now(*stretched.scene, &table), fresh(*stretched.scene);
    REQUIRE(now.ownTree(1));
    CHECK(now.ownTree(1)->own != table.ownTree(1)->own);
    CHECK(now.ownTree(1)->own == now.ownTree(2)->own);
    int moved = 0;
    for (uint32_t t = 0; t < mesh->triangles.size(); ++t)
        moved += now.ownTree(1)->own->numberOf(t) != table.ownTree(1)->own->numberOf(t);
    CHECK(moved == 0);
    CHECK(now.area(1) == fresh.area(1));
    CHECK(now.area(1) > 1.05f * table.area(1));
    CHECK(worstSum(*now.tree(), 50) < 2e-5);
}

TEST_CASE("mesh light tree: what the next deformation would use is freed at rest", "[shading]")
{
    const SceneBuilder builder = shining(halfSphere(), {});
    const SceneBuilder stretched = shining(halfSphere(1.2f), {});
    auto before = std::make_unique<const LightTable>(*builder.scene);
    const LightTable now(*stretched.scene, before.get());
    before.reset();
    const LightTree& own = *now.ownTree(1)->own->tree;
    REQUIRE(own.hasSpare());
    REQUIRE(now.tree()->top()->hasSpare());
    const LightTable resting(*stretched.scene, &now);
    REQUIRE(resting.ownTree(1)->own->tree.get() == &own);
    CHECK_FALSE(own.hasSpare());
    CHECK_FALSE(now.tree()->top()->hasSpare());
}

TEST_CASE("mesh light tree: places that stretch unevenly, and small meshes, have none", "[shading]")
{
    Places places;
    places.first.linear[1] *= 1.01f;
    const SceneBuilder builder = shining(halfSphere(), places);
    const LightTable table(*builder.scene);
    CHECK_FALSE(table.ownTree(1));
    CHECK(table.ownTree(2));
    CHECK(table.area(1) == Approx(16.0f * table.area(2)).epsilon(0.02));
    CHECK(table.emitterOf(1, 500) < table.tree()->size());
    CHECK(worstSum(*table.tree(), 20) < 2e-5);
    const SceneBuilder small = shining(sphereMesh(Vec3(0.0f), 0.5f, 10), {});
    CHECK_FALSE(LightTable(*small.scene).ownTree(1));
}

TEST_CASE("mesh light tree: none if all triangles of instances cannot be numbered", "[shading]")
{
    const auto mesh = sphereMesh(Vec3(0.0f), 0.5f, 256);
    const uint32_t shining = 0xffffffffu / static_cast<uint32_t>(mesh->triangles.size()) + 1;
    SceneBuilder builder;
    const uint32_t first = builder.addEmissive(mesh, lamp(Vec3(1.0f)));
    Scene& scene = *builder.scene;
    scene.instances[first].placed = true;
    const Instance instance = scene.instances[first];
    const Light light = scene.lights[0];
    for (uint32_t i = 1; i < shining; ++i)
    {
        scene.instances.push_back(instance);
        scene.instances.back().engineFromLocal.translation.x = float(i);
        scene.lights.push_back(light);
        scene.lights.back().instance = static_cast<uint32_t>(scene.instances.size() - 1);
    }
    const LightTable table(scene);
    CHECK_FALSE(table.tree());
    CHECK_FALSE(table.ownTree(0));
    REQUIRE(table.areaLights().size() == shining);
    CHECK(table.sampleArea(shining - 1, Vec3(float(shining), 0.0f, 2.0f), 0.3f, 0.6f));
    scene.lights.pop_back();
    CHECK(LightTable(scene).tree());
}
