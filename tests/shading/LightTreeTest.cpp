// LightTreeTest.cpp - probabilities of a light tree: their sum, the frequencies of its choices, the
// variance of the estimator that chooses by them, and trees that are refitted.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"
#include "tests/shading/TwoPicks.h"

#include "osgRayTrace/shading/SoftLight.h"

#include <functional>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// A square lamp with its centre and its two half edges.
struct Lamp
{
    Vec3d centre, u, v;
    bool twoSided;
};

Vec3d directionOf(Uniform& random)
{
    const double z = random.between(-1, 1), turn = random.between(0, 2 * M_PI);
    return {std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn), z};
}

/// Returns lamps in a box of 20 x 20 x 4 around the origin. hanging: they all shine down.
std::vector<Lamp> lamps(int count, bool hanging, uint32_t seed)
{
    Uniform random(seed);
    std::vector<Lamp> result;
    for (int i = 0; i < count; ++i)
    {
        const double z = random.between(2, 6), y = random.between(-10, 10);
        const Vec3d centre(random.between(-10, 10), y, z);
        const Vec3d normal = hanging ? Vec3d(0, 0, -1) : directionOf(random);
        const Vec3d across = glm::normalize(glm::cross(normal, Vec3d(0.6, 0.8, 0.1)));
        const double half = 0.5 * random.between(0.05, 0.3);
        result.push_back(
            {centre, across * half, glm::cross(normal, across) * half, !hanging && i % 5 == 0});
    }
    return result;
}

SceneBuilder sceneOf(const std::vector<Lamp>& lamps)
{
    SceneBuilder builder;
    for (const Lamp& lamp : lamps)
        builder.addQuadLight(Vec3(lamp.centre - lamp.u - lamp.v), Vec3(2.0 * lamp.u),
                             Vec3(2.0 * lamp.v), Vec3(1.0f), lamp.twoSided);
    return builder;
}

/// Adds point lights, spots, soft ones and an emitting sphere to lamps of all orientations.
SceneBuilder mixedScene()
{
    SceneBuilder builder = sceneOf(lamps(60, false, 3));
    Uniform random(4);
    for (int i = 0; i < 40; ++i)
    {
        Light light =
            pointLight(Vec3(random.between(-10, 10), random.between(-10, 10), 3.0), Vec3(0.01f));
        if (i % 4 == 1)
        {
            light.direction = Vec3(directionOf(random));
            light.spotCosCutoff = 0.8f;
            light.spotExponent = i % 8 == 1 ? 20.0f : 0.0f;
        }
        if (i % 4 == 2) light.radius = 0.3f;
        if (i % 3 == 0) light.range = 7.0f;
        if (i % 4 == 3)
        {
            light.attenuationConstant = 1.0f;
            light.attenuationQuadratic = 0.0f;
        }
        builder.addLight(light);
    }
    builder.addEmissive(sphereMesh({3, 3, 3}, 0.5f, 6), lamp(Vec3(0.5f)));
    return builder;
}

/// Returns the vector sum of Lambert's formula for a lamp: its product with the normal is the
/// irradiance for radiance 1 at a point that sees all of the lamp above its horizon [Lambert 1760].
double irradiance(const Lamp& lamp, Vec3d p, Vec3d normal)
{
    const Vec3d n = glm::cross(lamp.u, lamp.v);
    const double side = glm::dot(p - lamp.centre, n);
    if (side <= 0.0 && !lamp.twoSided) return 0.0;
    const Vec3d corners[4] = {lamp.centre - lamp.u - lamp.v, lamp.centre + lamp.u - lamp.v,
                              lamp.centre + lamp.u + lamp.v, lamp.centre - lamp.u + lamp.v};
    double sum = 0.0;
    for (int k = 0; k < 4; ++k)
    {
        const Vec3d a = glm::normalize(corners[k] - p),
                    b = glm::normalize(corners[(k + 1) % 4] - p);
        const Vec3d c = glm::cross(a, b);
        const double length = glm::length(c);
        sum += std::atan2(length, glm::dot(a, b)) * glm::dot(c, normal) / length;
    }
    return 0.5 * std::abs(sum);
}

struct Receiver
{
    Vec3 p, normal;
};

Receiver receiver(Uniform& random)
{
    return {Vec3(random.between(-12, 12), random.between(-12, 12), random.between(-1, 7)),
            Vec3(directionOf(random))};
}

Vec3d vectorOf(const float (&words)[3])
{
    return {words[0], words[1], words[2]};
}

/// Returns whether light from a point of the emitter, at (u, v) of its edges, reaches the receiver.
bool reaches(const LightEmitter& e, const Light& light, const Receiver& at, Vec2 uv)
{
    if (e.isPoint())
    {
        const SoftLightSample sample = sampleSoft(light, at.p, uv);
        return sample.attenuation > 0.0f && glm::dot(sample.wi, at.normal) > 1e-3f;
    }
    if ((e.flags & kTriangle) && uv.x + uv.y > 1.0f) return false;
    const Vec3d u = vectorOf(e.edgeU), v = vectorOf(e.edgeV);
    const Vec3d wi =
        glm::normalize(vectorOf(e.corner) + double(uv.x) * u + double(uv.y) * v - Vec3d(at.p));
    const double cosine = -glm::dot(wi, glm::normalize(glm::cross(u, v)));
    return (e.flags & kTwoSided ? std::abs(cosine) : cosine) > 1e-3 &&
           glm::dot(wi, Vec3d(at.normal)) > 1e-3;
}

/// Returns the exact variance of f / pmf for an emitter that a tree chooses: sum f^2 / pmf - S^2.
/// It is -1 if an emitter with f > 0 is never chosen.
double varianceOf(const SceneLightTree& tree, const Receiver& at, const std::vector<double>& f)
{
    double sum = 0.0, squares = 0.0;
    for (uint32_t e = 0; e < tree.size(); ++e)
    {
        const double pmf = tree.pmf(at.p, at.normal, e);
        if (f[e] > 0.0 && !(pmf > 0.0)) return -1.0;
        sum += f[e];
        squares += f[e] > 0.0 ? f[e] * f[e] / pmf : 0.0;
    }
    return squares - sum * sum;
}

/// Returns the irradiances of the lamps in the order of a tree's emitters.
std::vector<double> irradiances(const SceneLightTree& tree, const std::vector<Lamp>& lamps,
                                const Receiver& at)
{
    std::vector<double> f;
    for (uint32_t e = 0; e < tree.size(); ++e)
        f.push_back(irradiance(lamps[tree.emitter(e).light], Vec3d(at.p), Vec3d(at.normal)));
    return f;
}

/// Holds what many choices of a tree estimate.
Estimate estimateOf(const SceneLightTree& tree, const Receiver& at, const std::vector<double>& f,
                    int draws, Uniform& random)
{
    Estimate estimate;
    for (int i = 0; i < draws; ++i)
    {
        const SceneLightTree::Choice choice = tree.choose(at.p, at.normal, random());
        estimate.add(f[choice.emitter] / choice.pmf);
    }
    return estimate;
}

const Receiver kFloor[] = {{{0, 0, 0}, {0, 0, 1}},
                           {{7, -4, 0}, {0, 0, 1}},
                           {{-11, 9, 1.5f}, {0, 0, 1}},
                           {{3, 3, 1.9f}, {0, 0, 1}}};

} // namespace

TEST_CASE("light tree: probabilities sum to 1 at 100,000 random points", "[shading]")
{
    const SceneBuilder builder = mixedScene();
    const LightTable table(*builder.scene);
    REQUIRE(table.tree());
    const SceneLightTree& tree = *table.tree();
    REQUIRE(tree.size() == 60 + 40 + 6 * 12 * 2 - 2 * 12);
    Uniform random(1);
    double worst = 0.0;
    for (int i = 0; i < 100000; ++i)
    {
        const Receiver at = receiver(random);
        // All probabilities are looked up at some points, and those of a few emitters at others.
        const bool all = i % 50 == 0;
        double sum = 0.0;
        for (uint32_t k = 0; k < tree.size() && all; ++k)
            sum += tree.pmf(at.p, at.normal, k);
        if (all) worst = std::max(worst, std::abs(sum - 1.0));
        const SceneLightTree::Choice choice = tree.choose(at.p, at.normal, random());
        REQUIRE(choice.emitter < tree.size());
        REQUIRE(choice.pmf > 0.0f);
        REQUIRE(choice.pmf == Approx(tree.pmf(at.p, at.normal, choice.emitter)).epsilon(1e-5));
    }
    CHECK(worst < 1e-5);
}

TEST_CASE("light tree: choices have the probabilities that they claim",
          "[shading][statistics][long]")
{
    // One by one and in lanes, at points with opaque and with transmitting surfaces. There is 1 %
    // of false alarms in all tests together (Sidak).
    constexpr int kPoints = 12, kDraws = 1 << 18;
    const double significance = sidak(0.01, 2 * kPoints);
    const SceneBuilder builder = mixedScene();
    const LightTable table(*builder.scene);
    const SceneLightTree& tree = *table.tree();
    Uniform random(5);
    for (int k = 0; k < kPoints; ++k)
    {
        Receiver at = receiver(random);
        if (k % 3 == 0) at.normal = Vec3(0.0f);
        std::vector<double> single(tree.size()), lanes(tree.size()), expected;
        for (uint32_t e = 0; e < tree.size(); ++e)
            expected.push_back(kDraws * double(tree.pmf(at.p, at.normal, e)));
        Vec3Lanes p, normal;
        for (int i = 0; i < kLanes; ++i)
        {
            setLane(p, i, at.p);
            setLane(normal, i, at.normal);
        }
        for (int draw = 0; draw < kDraws; draw += kLanes)
        {
            const SceneLightTree::Pick pick = pickOf(tree, p, normal, draw / kLanes, random);
            const UintLanes& emitters = pick.emitters;
            const FloatLanes& pmf = pick.pmf;
            for (int i = 0; i < kLanes; ++i)
            {
                ++lanes[emitters[i]];
                ++single[tree.choose(at.p, at.normal, random()).emitter];
                REQUIRE(double(pmf[i]) * kDraws == Approx(expected[emitters[i]]).epsilon(1e-4));
            }
        }
        CAPTURE(k);
        CHECK(chiSquareTest(single, expected) > significance);
        CHECK(chiSquareTest(lanes, expected) > significance);
    }
}

TEST_CASE("light tree: no light that reaches a point has probability 0", "[shading]")
{
    const SceneBuilder builder = mixedScene();
    const LightTable table(*builder.scene);
    const SceneLightTree& tree = *table.tree();
    Uniform random(6);
    int lit = 0, dark = 0;
    for (int i = 0; i < 3000; ++i)
    {
        const Receiver at = receiver(random);
        for (uint32_t e = 0; e < tree.size(); ++e)
        {
            const LightEmitter emitter = tree.emitter(e);
            bool any = false;
            for (const Vec2 uv : {Vec2(0.01f, 0.01f), Vec2(0.98f, 0.01f), Vec2(0.01f, 0.98f),
                                  Vec2(0.49f, 0.49f), Vec2(0.98f, 0.98f)})
                any |= reaches(emitter, builder.scene->lights[emitter.light], at, uv);
            ++(any ? lit : dark);
            if (any && !(tree.pmf(at.p, at.normal, e) > 0.0f))
                FAIL("emitter " << e << " at point " << i);
        }
    }
    CHECK(lit > 100000);
    CHECK(dark > 100000);
}

TEST_CASE("light tree: the variance in an open plane is that of its probabilities",
          "[shading][long][statistics]")
{
    // f is exact by Lambert's formula, so that the choice is all of the noise. The sample variance
    // of 2^21 draws has an error of about 0.5 % in a distribution of this kurtosis.
    const std::vector<Lamp> hanging = lamps(1000, true, 7);
    const SceneBuilder builder = sceneOf(hanging);
    const LightTable table(*builder.scene);
    const SceneLightTree& tree = *table.tree();
    REQUIRE(tree.size() == 1000);
    Uniform random(8);
    for (const Receiver& at : kFloor)
    {
        const std::vector<double> f = irradiances(tree, hanging, at);
        double sum = 0.0, area = 0.0, power = 0.0;
        for (uint32_t e = 0; e < tree.size(); ++e)
        {
            sum += f[e];
            area += tree.emitter(e).area;
            power += f[e] * f[e] / tree.emitter(e).area;
        }
        power *= area;
        const Estimate estimate = estimateOf(tree, at, f, 1 << 21, random);
        const double exact = varianceOf(tree, at, f);
        CAPTURE(at.p.x, at.p.y, exact / (sum * sum), power / (sum * sum) - 1.0);
        CHECK(estimate.agrees(sum));
        CHECK(estimate.variance() == Approx(exact).epsilon(0.03));
        // The choice by power, which needs no tree, has many times as much.
        CHECK(exact < 0.3 * (power - sum * sum));
    }
}

TEST_CASE("light tree: lights that have moved keep the shape, and the estimator its mean",
          "[shading][statistics][long]")
{
    std::vector<Lamp> hanging = lamps(300, true, 9);
    const SceneBuilder before = sceneOf(hanging);
    const LightTable table(*before.scene);
    const LightTable same(*before.scene, &table);
    CHECK(same.tree() == table.tree());

    Uniform random(10);
    for (Lamp& lamp : hanging)
        lamp.centre += 0.2 * directionOf(random);
    const SceneBuilder after = sceneOf(hanging);
    const LightTable refitted(*after.scene, &table), fresh(*after.scene);
    REQUIRE(refitted.tree() != table.tree());
    // The shape is the old one: the order of the leaves tells.
    int kept = 0;
    for (uint32_t e = 0; e < 300; ++e)
        kept += refitted.tree()->emitter(e).light == table.tree()->emitter(e).light;
    CHECK(kept == 300);
    for (const Receiver& at : kFloor)
    {
        const std::vector<double> f = irradiances(*refitted.tree(), hanging, at),
                                  g = irradiances(*fresh.tree(), hanging, at);
        double sum = 0.0;
        for (const double value : f)
            sum += value;
        CHECK(estimateOf(*refitted.tree(), at, f, 1 << 18, random).agrees(sum));
        CHECK(estimateOf(*fresh.tree(), at, g, 1 << 18, random).agrees(sum));
        CHECK(varianceOf(*refitted.tree(), at, f) > 0.0);
    }

    // Lights that were neighbours part: the shape is made anew.
    for (Lamp& lamp : hanging)
        lamp.centre = Vec3d(random.between(-100, 100), random.between(-100, 100), 3);
    const SceneBuilder apart = sceneOf(hanging);
    const LightTable again(*apart.scene, &table), own(*apart.scene);
    int alike = 0;
    for (uint32_t e = 0; e < 300; ++e)
        alike += again.tree()->emitter(e).light == own.tree()->emitter(e).light;
    CHECK(alike == 300);
}

TEST_CASE("light tree: point lights that turn, brighten or fade otherwise have other bounds",
          "[shading]")
{
    const Receiver below{{0, 0, 0}, {0, 0, 1}};
    const auto spots = []
    {
        SceneBuilder builder;
        for (int i = 0; i < 20; ++i)
        {
            Light light = pointLight(Vec3(i - 10.0f, 0, 5));
            light.direction = Vec3(0, 0, 1); // away from the receiver
            light.spotCosCutoff = 0.9f;
            light.spotExponent = 4.0f;
            builder.addLight(light);
        }
        return builder;
    };
    const SceneBuilder away = spots();
    const LightTable table(*away.scene);
    const LightTable same(*away.scene, &table);
    CHECK(same.tree() == table.tree());
    const std::function<void(Light&)> changes[] = {
        [](Light& light) { light.direction = Vec3(0, 0, -1); },
        [](Light& light) { light.spotCosCutoff = -1.0f; },
        [](Light& light) { light.spotExponent = 0.0f; },
        [](Light& light) { light.diffuse *= 3.0f; },
        [](Light& light) { light.radius = 0.2f; },
        [](Light& light) { light.attenuationLinear = 0.3f; },
    };
    for (const auto& change : changes)
    {
        const SceneBuilder edited = spots();
        change(edited.scene->lights[10]);
        const LightTable now(*edited.scene, &table);
        CHECK(now.tree() != table.tree());
    }
    const SceneBuilder turned = spots();
    changes[0](turned.scene->lights[10]);
    const LightTable now(*turned.scene, &table);
    CHECK(now.tree()->pmf(below.p, below.normal, now.tree()->top()->numberOf(10)) == Approx(1.0));
}

TEST_CASE("light tree: bounds of two hold all that either holds", "[shading]")
{
    Uniform random(11);
    for (int i = 0; i < 20000; ++i)
    {
        LightBounds parts[2];
        for (LightBounds& b : parts)
        {
            b.axis = Vec3(directionOf(random));
            b.cosCone = i % 3 == 0 ? 1.0f : static_cast<float>(random.between(-1, 1));
            b.cosEmission = static_cast<float>(random.between(0, 0.5));
            b.intensity = static_cast<float>(random.between(0.1, 2));
            b.low = Vec3(directionOf(random));
            b.high = b.low + Vec3(0.5f);
        }
        const LightBounds both = joined(parts[0], parts[1]);
        REQUIRE(both.intensity == Approx(parts[0].intensity + parts[1].intensity));
        for (const LightBounds& b : parts)
        {
            REQUIRE(both.cosEmission <= b.cosEmission);
            REQUIRE(glm::all(glm::lessThanEqual(both.low, b.low)));
            const double between =
                std::acos(std::clamp(glm::dot(Vec3d(both.axis), Vec3d(b.axis)), -1.0, 1.0));
            const double reach = std::min(between + std::acos(double(b.cosCone)), M_PI);
            REQUIRE(std::acos(double(both.cosCone)) >= reach - 2e-3);
        }
        // It is not much wider than it must be.
        const double between =
            std::acos(std::clamp(glm::dot(Vec3d(parts[0].axis), Vec3d(parts[1].axis)), -1.0, 1.0));
        const double a = std::acos(double(parts[0].cosCone)),
                     b = std::acos(double(parts[1].cosCone));
        const double least = std::min(std::max(std::max(a, b), 0.5 * (a + b + between)), M_PI);
        REQUIRE(std::acos(double(both.cosCone)) <= least + 1e-2);
    }
}

TEST_CASE("light tree: a few lights need none", "[shading]")
{
    const SceneBuilder few = sceneOf(lamps(int(kMostWithoutTree), true, 1));
    CHECK_FALSE(LightTable(*few.scene).tree());
    const SceneBuilder more = sceneOf(lamps(int(kMostWithoutTree) + 1, true, 1));
    CHECK(LightTable(*more.scene).tree());
}
