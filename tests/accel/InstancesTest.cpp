// InstancesTest.cpp - placed meshes are hit where they are, and take little memory. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Rays.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/Outline.h"

#include <glm/gtc/matrix_transform.hpp>
#include <malloc.h>

#include <algorithm>
#include <functional>
#include <random>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

class Random
{
public:
    explicit Random(uint32_t seed) : _engine(seed) {}
    float between(float low, float high)
    {
        return low + (high - low) * static_cast<float>(_engine()) * 0x1p-32f;
    }
    Vec3 within(float size)
    {
        const float x = between(-size, size), y = between(-size, size);
        return {x, y, between(-size, size)};
    }
    uint32_t below(uint32_t count) { return _engine() % count; }

private:
    std::mt19937 _engine;
};

/// Returns a transform that rotates, scales by axis and shears; half of the transforms mirror.
Affine anyTransform(Random& random)
{
    const Vec3 axis = random.within(1.0f) + Vec3(0.0f, 0.0f, 1e-3f);
    Affine m;
    m.linear = Mat3(glm::rotate(Mat4(1.0f), random.between(0.0f, 6.0f), axis));
    Mat3 shape(random.between(0.2f, 2.0f));
    shape[1][1] = random.between(0.2f, 2.0f);
    shape[2][2] = random.between(-2.0f, 2.0f) < 0.0f ? -0.7f : 1.3f;
    shape[1][0] = random.between(-1.0f, 1.0f);
    shape[2][0] = random.between(-1.0f, 1.0f);
    m.linear = m.linear * shape;
    m.translation = random.within(6.0f);
    return m;
}

Instance placedInstance(uint32_t mesh, const Affine& m)
{
    Instance instance;
    instance.mesh = mesh;
    instance.placed = true;
    instance.engineFromLocal = m;
    instance.mirrored = glm::determinant(m.linear) < 0.0f;
    return instance;
}

/// Returns instances of two meshes in turn; the first two instances are in place.
std::shared_ptr<Scene> manyInstances(Random& random, uint32_t count)
{
    SceneBuilder builder;
    builder.add(boxMesh(Vec3(-7.0f, -7.0f, -7.5f), Vec3(7.0f, 7.0f, -7.0f)), lambert(Vec3(0.5f)));
    builder.add(sphereMesh(Vec3(0.0f), 0.5f, 6), lambert(Vec3(0.5f)));
    builder.scene->meshes.push_back(sphereMesh(Vec3(0.3f, 0.0f, -0.2f), 1.0f, 12));
    builder.scene->meshes.push_back(boxMesh(Vec3(-1.0f, -0.5f, 0.0f), Vec3(0.5f, 1.0f, 1.0f)));
    for (uint32_t i = 0; i < count; ++i)
        builder.scene->instances.push_back(placedInstance(2 + i % 2, anyTransform(random)));
    return builder.scene;
}

struct Ray
{
    Vec3 origin, direction;
};

struct Truth
{
    bool clear = true; ///< no edge and no other triangle is so near that rounding could decide
    uint32_t instance = kInvalid, primitive = 0;
    double t = 1e30;
};

/// Tests all triangles one after the other, in double, by Cramer's rule.
Truth bruteForce(const Scene& scene, const Ray& ray)
{
    constexpr double kEdge = 1e-4, kGap = 1e-4;
    Truth truth;
    std::vector<double> near; // distances of triangles that are hit or nearly so
    const Vec3d origin(ray.origin), direction(ray.direction);
    for (uint32_t i = 0; i < scene.instances.size(); ++i)
    {
        const Instance& instance = scene.instances[i];
        const Mesh& mesh = *scene.meshes[instance.mesh];
        const glm::dmat3 linear =
            instance.placed ? glm::dmat3(instance.engineFromLocal.linear) : glm::dmat3(1.0);
        const Vec3d shift =
            instance.placed ? Vec3d(instance.engineFromLocal.translation) : Vec3d(0.0);
        std::vector<Vec3d> points;
        for (const Vec3& p : mesh.positions)
            points.push_back(linear * Vec3d(p) + shift);
        for (uint32_t k = 0; k < mesh.triangles.size(); ++k)
        {
            const UVec3& c = mesh.triangles[k];
            const Vec3d a = points[c.x], e1 = points[c.y] - a, e2 = points[c.z] - a;
            const Vec3d p = glm::cross(direction, e2), s = origin - a, q = glm::cross(s, e1);
            const double determinant = glm::dot(e1, p);
            const double u = glm::dot(s, p) / determinant, v = glm::dot(direction, q) / determinant;
            const double t = glm::dot(e2, q) / determinant;
            const double inside = std::min({u, v, 1.0 - u - v});
            if (!(inside > -kEdge) || !(t > -kGap)) continue;
            near.push_back(t);
            if (inside > 0.0 && t > 0.0 && t < truth.t)
            {
                truth.instance = i;
                truth.primitive = k;
                truth.t = t;
                truth.clear = inside > kEdge;
            }
        }
    }
    std::sort(near.begin(), near.end());
    if (truth.instance == kInvalid)
        truth.clear = near.empty();
    else
        truth.clear &= near[0] == truth.t && (near.size() < 2 || near[1] > truth.t + kGap);
    return truth;
}

using Query = std::function<void(const Intersector&, const Ray*, Hit*)>; ///< of sixteen rays

Hit hitOf(const RayHitBlock& block, int i)
{
    if (block.geometry[i] == kInvalid) return {};
    return {hitInstance(block.geometry[i], block.instance[i]), block.primitive[i], block.u[i],
            block.v[i], block.ray.tFar[i]};
}

/// Returns a query by blocks in which the given number of lanes is active at a time.
Query blocks(Coherence coherence, int lanesAtOnce)
{
    return [=](const Intersector& intersector, const Ray* rays, Hit* hits)
    {
        for (int first = 0; first < kLanes; first += lanesAtOnce)
        {
            RayHitBlock block;
            for (int i = 0; i < kLanes; ++i)
                setRay(block.ray, i, rays[i].origin, rays[i].direction);
            const LaneMask active = ((1u << lanesAtOnce) - 1u) << first;
            CHECK(intersector.closestHits(block, active, coherence) == 0);
            for (int i = first; i < first + lanesAtOnce; ++i)
                hits[i] = hitOf(block, i);
        }
    };
}

/// Returns rays through the scene; the sixteen rays of each packet are close to each other.
std::vector<Ray> someRays(Random& random, int packets)
{
    std::vector<Ray> rays;
    for (int p = 0; p < packets; ++p)
    {
        const Vec3 from = random.within(12.0f), to = random.within(6.0f);
        for (int i = 0; i < kLanes; ++i)
            rays.push_back({from, glm::normalize(to + random.within(0.5f) - from)});
    }
    return rays;
}

std::size_t bytesInUse()
{
    const struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
}

constexpr bool kCountsMemory =
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    false;
#else
    true;
#endif

} // namespace

TEST_CASE("instances: rays of every kind hit what brute force in double hits", "[accel]")
{
    Random random(5);
    const auto scene = manyInstances(random, 40);
    const auto traced = TracedScene::build(scene, std::make_shared<Workers>(1));
    const Intersector& intersector = traced->intersector();
    const std::vector<Ray> rays = someRays(random, 60);
    const Query singly = [](const Intersector& rayTracer, const Ray* r, Hit* hits)
    {
        for (int i = 0; i < kLanes; ++i)
            hits[i] =
                rayTracer.closestHit(r[i].origin, r[i].direction, 0.0f, kInfinity).value_or(Hit());
    };
    const Query queries[] = {singly, blocks(Coherence::Coherent, 16),
                             blocks(Coherence::Incoherent, 16), blocks(Coherence::Incoherent, 4),
                             blocks(Coherence::Incoherent, 1)};
    int clear = 0, inPlace = 0, placed = 0, missed = 0, wrong = 0;
    double worst = 0.0;
    for (std::size_t first = 0; first < rays.size(); first += kLanes)
    {
        Truth truths[kLanes];
        for (int i = 0; i < kLanes; ++i)
            truths[i] = bruteForce(*scene, rays[first + i]);
        for (const Query& query : queries)
        {
            Hit hits[kLanes];
            query(intersector, &rays[first], hits);
            for (int i = 0; i < kLanes; ++i)
            {
                if (!truths[i].clear) continue;
                wrong += hits[i].instance != truths[i].instance;
                if (hits[i].instance == kInvalid) continue;
                wrong += hits[i].primitive != truths[i].primitive;
                worst = std::max(worst, std::fabs(hits[i].t - truths[i].t) / truths[i].t);
            }
        }
        RayBlock shadows;
        for (int i = 0; i < kLanes; ++i)
            setRay(shadows, i, rays[first + i].origin, rays[first + i].direction);
        intersector.occlusion(shadows, kAllLanes);
        for (int i = 0; i < kLanes; ++i)
        {
            if (!truths[i].clear) continue;
            ++clear;
            const bool hit = truths[i].instance != kInvalid;
            missed += !hit;
            inPlace += hit && !scene->instances[truths[i].instance].placed;
            placed += hit && scene->instances[truths[i].instance].placed;
            wrong += (shadows.tFar[i] < 0.0f) != hit;
            const Ray& ray = rays[first + i];
            wrong += intersector.occluded(ray.origin, ray.direction, 0.0f, kInfinity) != hit;
        }
    }
    CAPTURE(clear, missed, inPlace, placed, worst);
    CHECK(wrong == 0);
    CHECK(worst < 1e-5);
    CHECK(clear > 900);
    CHECK(missed > 50);
    CHECK(inPlace > 50);
    CHECK(placed > 200);
}

TEST_CASE("instances: what is taken over from the last scene is hit as in a new one", "[accel]")
{
    Random random(6);
    const auto workers = std::make_shared<Workers>(1);
    auto scene = manyInstances(random, 12);
    std::shared_ptr<const TracedScene> last, previous; // a view may still trace the previous one
    for (int edit = 0; edit < 60; ++edit)
    {
        auto next = std::make_shared<Scene>(*scene);
        std::vector<Instance>& instances = next->instances;
        const uint32_t chosen = 2 + random.below(static_cast<uint32_t>(instances.size()) - 2);
        switch (edit % 5)
        {
        case 0:
        case 1:
            instances[chosen].engineFromLocal = anyTransform(random);
            break;
        case 2:
            instances.push_back(placedInstance(2 + random.below(2), anyTransform(random)));
            break;
        case 3:
            instances.erase(instances.begin() + chosen);
            break;
        default:
            std::swap(instances[chosen], instances[2]);
            if (edit == 44) instances[1].placed = true; // leaves the static BVH
            if (edit == 54) instances.resize(1);        // all others are removed
        }
        scene = next;
        if (instances.size() < 4)
            for (int i = 0; i < 6; ++i)
                scene->instances.push_back(placedInstance(2, anyTransform(random)));
        previous = last;
        last = TracedScene::build(scene, workers, last);
        const auto fresh = TracedScene::build(scene, workers);
        int different = 0;
        for (const Ray& ray : someRays(random, 8))
        {
            const auto shoot = [&](const TracedScene& traced)
            {
                return traced.intersector()
                    .closestHit(ray.origin, ray.direction, 0.0f, kInfinity)
                    .value_or(Hit());
            };
            const Hit a = shoot(*last), b = shoot(*fresh);
            different += a.instance != b.instance || a.primitive != b.primitive || a.t != b.t;
        }
        CAPTURE(edit);
        REQUIRE(different == 0);
    }
}

TEST_CASE("instances: bounds hold a mesh wherever it is placed, and a turned ball closely",
          "[accel]")
{
    Random random(7);
    const auto ball = sphereMesh(Vec3(0.5f, -1.0f, 2.0f), 1.0f, 24);
    const auto bounded = [](const Mesh& mesh)
    {
        Box box;
        for (const Vec3& p : mesh.positions)
            box = {glm::min(box.low, p), glm::max(box.high, p)};
        return box;
    };
    // This mesh has the ball's triangles and one vertex more, which no triangle uses.
    auto stray = std::make_shared<Mesh>(*ball);
    std::vector<Vec3> positions(ball->positions.begin(), ball->positions.end());
    positions.push_back(Vec3(1e6f));
    stray->positions = std::move(positions);
    for (const std::shared_ptr<Mesh>& mesh :
         {ball, stray, boxMesh(Vec3(3.0f), Vec3(4.0f, 5.0f, 3.0f))})
    {
        const Box box = bounded(mesh == stray ? *ball : *mesh);
        const Outline outline(*mesh, box);
        int outside = 0;
        float widest = 0.0f;
        for (int k = 0; k < 300; ++k)
        {
            Affine m = anyTransform(random);
            if (k % 3 == 0) m.translation *= 1e5f;
            if (k % 3 == 1) m.linear = Mat3(glm::rotate(Mat4(1.0f), float(k), random.within(1.0f)));
            const Box placed = outline.placedBounds(m);
            for (uint32_t i = 0; i < mesh->positions.size() - (mesh == stray ? 1 : 0); ++i)
            {
                const Vec3d p =
                    glm::dmat3(m.linear) * Vec3d(mesh->positions[i]) + Vec3d(m.translation);
                for (int axis = 0; axis < 3; ++axis)
                    outside += p[axis] < placed.low[axis] || p[axis] > placed.high[axis];
            }
            const Vec3 size = placed.high - placed.low;
            if (k % 3 == 1) widest = std::max({widest, size.x, size.y, size.z});
        }
        CAPTURE(mesh->positions.size(), widest);
        CHECK(outside == 0);
        if (mesh == ball || mesh == stray) CHECK(widest < 1.3f * 2.0f); // a box: up to 1.73 times
    }
}

TEST_CASE("instances: each takes less than 300 bytes, Embree's share included", "[accel]")
{
    constexpr uint32_t kFew = 1000, kMany = 11000;
    const auto workers = std::make_shared<Workers>(1);
    const auto grid = [](uint32_t count)
    {
        SceneBuilder builder;
        builder.scene->meshes.push_back(sphereMesh(Vec3(0.0f), 0.5f, 8));
        builder.material(lambert(Vec3(0.5f)));
        builder.scene->instances.reserve(count);
        for (uint32_t i = 0; i < count; ++i)
        {
            Affine m;
            m.translation = Vec3(float(i % 100), float(i / 100), 0.0f);
            builder.scene->instances.push_back(placedInstance(0, m));
        }
        return builder.scene;
    };
    struct Use
    {
        double embree, heap;
    };
    const auto measure = [&](uint32_t count)
    {
        const std::size_t before = bytesInUse();
        const auto traced = TracedScene::build(grid(count), workers);
        return Use{double(traced->embreeBytes()), double(bytesInUse()) - double(before)};
    };
    measure(kFew); // allocates what is allocated once
    const Use few = measure(kFew), many = measure(kMany);
    const double embree = (many.embree - few.embree) / (kMany - kFew);
    const double heap = (many.heap - few.heap) / (kMany - kFew);
    CAPTURE(embree, heap);
    CHECK(embree < 140.0); // the BVH: 67 if nodes are narrow
    if (!kCountsMemory) return;
    // The scene takes 72 bytes an instance, rays take 64 and the search for changes takes 12.
    // Embree's own instances are included.
    CHECK(heap - embree > sizeof(Instance));
    CHECK(heap - embree < 160.0);
}
