// PhotonEmitterTest.cpp - lights emit the power that their formulas give, however photons are
// guided.
// SPDX-License-Identifier: MIT
#include "tests/photons/PhotonMeans.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns a large floor and, well inside of the bounding sphere, a small glass ball and a mirror
/// as targets.
SceneBuilder stage()
{
    SceneBuilder builder;
    builder.add(quadMesh({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}), lambert(Vec3(0.5f)));
    builder.add(sphereMesh(kBall, kBallRadius, 16), glass(1.5f));
    builder.add(quadMesh({-1, -1, 0.3f}, {0, 0.7f, 0}, {0, 0, 0.6f}), mirror(Vec3(1.0f)));
    return builder;
}

/// Returns a guide whose weights of lights and bins differ as far as they can.
std::shared_ptr<const PhotonGuide> anyGuide(const PhotonEmitter& emitter)
{
    Uniform uniform(5);
    std::vector<uint32_t> sent(emitter.guideBins(), 100u);
    std::vector<double> seen(emitter.guideBins());
    for (double& squares : seen)
        squares = uniform() < 0.5f ? 0.0 : double(uniform());
    return emitter.learn(sent, seen);
}

Flux emitted(const SceneBuilder& builder, float guidedShare, bool learnt = false)
{
    const auto traced = builder.build(1);
    const PhotonEmitter emitter(*traced, traced->scene().lights, guidedShare);
    REQUIRE(emitter.emits());
    REQUIRE(emitter.hasTargets());
    const auto photonGuide = learnt ? anyGuide(emitter) : nullptr;
    return emittedFlux(emitter, 23, photonGuide.get());
}

/// Checks the analytic flux without guiding, with two guided shares and with a learnt guide, and
/// that the ball gets the same flux.
void checkFlux(const SceneBuilder& builder, double expected)
{
    const Flux plain = emitted(builder, 0.0f);
    CAPTURE(plain.total.mean(), plain.total.standardError(), expected);
    CHECK(plain.total.agrees(expected, 1e-5 * expected));
    for (const auto& [share, learnt] : {std::pair(0.25f, false), {0.9f, false}, {0.9f, true}})
    {
        const Flux guided = emitted(builder, share, learnt);
        CAPTURE(share, learnt, guided.total.mean(), guided.total.standardError());
        CHECK(guided.total.agrees(expected, 1e-5 * expected));
        const double spread = std::hypot(plain.ball.standardError(), guided.ball.standardError());
        CAPTURE(plain.ball.mean(), guided.ball.mean(), spread);
        CHECK(plain.ball.mean() > 0.0);
        CHECK(std::abs(plain.ball.mean() - guided.ball.mean()) <= 4.0 * spread);
        if (share > 0.5f && !learnt)
            CHECK(guided.ball.standardError() < plain.ball.standardError());
    }
}

constexpr double kPiD = 3.14159265358979323846;

} // namespace

// Each call of checkFlux tests four means within 4 standard errors and three differences; a false
// alarm of all twelve calls has a probability of 5e-3 at most.
TEST_CASE("photon emission: a parallelogram, one side and two", "[photons][statistics]")
{
    for (const bool twoSided : {false, true})
    {
        SceneBuilder builder = stage();
        builder.addQuadLight({-0.5f, -0.5f, 3.0f}, {0, 0.6f, 0}, {0.5f, 0, 0}, Vec3(3.0f),
                             twoSided);
        checkFlux(builder, kPiD * 3.0 * 0.3 * (twoSided ? 2.0 : 1.0));
    }
}

TEST_CASE("photon emission: a mesh shines to both sides", "[photons][statistics]")
{
    SceneBuilder builder = stage();
    builder.addEmissive(quadMesh({-0.5f, -0.5f, 3.0f}, {0, 0.6f, 0}, {0.5f, 0, 0}),
                        lamp(Vec3(3.0f)));
    checkFlux(builder, kPiD * 3.0 * 0.3 * 2.0);
}

TEST_CASE("photon emission: a point light and spots", "[photons][statistics]")
{
    SceneBuilder point = stage();
    point.addLight(pointLight({0, 0, 2.5f}, Vec3(2.0f)));
    checkFlux(point, 2.0 * kPiD * 4.0 * kPiD);

    for (const float exponent : {0.0f, 5.0f})
    {
        Light light = pointLight({0.2f, 0, 3}, Vec3(2.0f));
        light.direction = glm::normalize(Vec3(0.1f, 0.05f, -1.0f));
        light.spotCosCutoff = 0.7f;
        light.spotExponent = exponent;
        SceneBuilder spot = stage();
        spot.addLight(light);
        const double e = double(exponent) + 1.0;
        checkFlux(spot,
                  2.0 * kPiD * 2.0 * kPiD / e * (1.0 - std::pow(double(light.spotCosCutoff), e)));
    }
}

TEST_CASE("photon emission: a directional light fills the scene's disc", "[photons][statistics]")
{
    Light light;
    light.kind = LightKind::Directional;
    light.diffuse = Vec3(2.0f);
    light.direction = glm::normalize(Vec3(0.3f, 0.2f, -1.0f));
    SceneBuilder builder = stage();
    builder.addLight(light);
    const auto traced = builder.build(1);
    const double radius =
        double(PhotonEmitter(*traced, traced->scene().lights, 0.0f).scene().radius);
    checkFlux(builder, 2.0 * kPiD * kPiD * radius * radius);
}

TEST_CASE("photon emission: lights of different power together", "[photons][statistics]")
{
    SceneBuilder builder = stage();
    builder.addQuadLight({-0.5f, -0.5f, 3.0f}, {0, 0.6f, 0}, {0.5f, 0, 0}, Vec3(3.0f));
    builder.addLight(pointLight({0, 0, 2.5f}, Vec3(0.05f)));
    builder.addLight(pointLight({0, 1, 2.5f}, Vec3(0.0f))); // dark: never chosen
    checkFlux(builder, kPiD * 3.0 * 0.3 + 0.05 * kPiD * 4.0 * kPiD);
}

TEST_CASE("photon emission: attenuation other than the square of the distance", "[photons]")
{
    SceneBuilder builder = stage();
    Light light = pointLight({0, 0, 2.5f});
    light.attenuationConstant = 0.5f;
    light.attenuationLinear = 0.25f;
    light.attenuationQuadratic = 0.125f;
    builder.addLight(light);
    light.range = 5.0f;
    builder.addLight(pointLight({0, 0, 2.5f}));
    builder.addQuadLight({-0.5f, -0.5f, 3.0f}, {0, 0.6f, 0}, {0.5f, 0, 0}, Vec3(3.0f));
    builder.addLight(light);
    const auto traced = builder.build(1);
    const PhotonEmitter emitter(*traced, traced->scene().lights, 0.0f);
    for (const float d : {0.01f, 1.0f, 7.0f})
    {
        const float window = std::max(1.0f - std::pow(d / 5.0f, 4.0f), 0.0f);
        CHECK(emitter.falloff(3, d) == Approx(window * emitter.falloff(0, d)).margin(1e-9));
        CHECK(emitter.falloff(0, d) == Approx(d * d / (0.5f + 0.25f * d + 0.125f * d * d)));
        CHECK(emitter.falloff(1, d) == Approx(1.0f));
        CHECK(emitter.falloff(2, d) == 1.0f);
    }
}

TEST_CASE("photon emission: dark lights emit nothing", "[photons]")
{
    SceneBuilder builder = stage();
    for (int k = 0; k < 1000; ++k)
        builder.addLight(pointLight({0, 0, 2.5f}, Vec3(0.0f)));
    const auto traced = builder.build(1);
    const PhotonEmitter emitter(*traced, traced->scene().lights, 0.5f);
    CHECK_FALSE(emitter.emits());
    CHECK_FALSE(emitter.emit({}).has_value());
}

TEST_CASE("photon emission: sixteen at once are what they are one by one", "[photons]")
{
    enum Kind
    {
        OneSided,
        TwoSided,
        Mesh,
        Two
    };
    for (const Kind kind : {OneSided, TwoSided, Mesh, Two})
    {
        SceneBuilder builder = stage();
        const Vec3 corner(-0.5f, -0.5f, 3.0f), edgeU(0, 0.6f, 0), edgeV(0.5f, 0, 0);
        if (kind == Mesh)
            builder.addEmissive(quadMesh(corner, edgeU, edgeV), lamp(Vec3(3.0f)));
        else
            builder.addQuadLight(corner, edgeU, edgeV, Vec3(3, 2, 1), kind == TwoSided);
        if (kind == Two) builder.addQuadLight({1, 1, 0.5f}, edgeU, edgeV, Vec3(1.0f), true);
        const auto traced = builder.build(1);
        for (const auto& [share, learnt] :
             {std::pair(0.0f, false), {0.25f, false}, {0.9f, false}, {0.9f, true}})
        {
            const PhotonEmitter emitter(*traced, traced->scene().lights, share);
            const auto photonGuide = learnt ? anyGuide(emitter) : nullptr;
            Uniform uniform(31);
            int different = 0, started = 0;
            for (int block = 0; block < 2000; ++block)
            {
                EmissionLanes points;
                for (int i = 0; i < kLanes; ++i)
                    for (FloatLanes* lanes :
                         {&points.light, &points.choice, &points.positionU, &points.positionV,
                          &points.directionU, &points.directionV})
                        (*lanes)[i] = uniform();
                StartLanes starts;
                const LaneMask alive = emitter.emitLanes(points, starts, photonGuide.get());
                for (int i = 0; i < kLanes; ++i)
                {
                    const auto start = emitter.emit({points.light[i],
                                                     points.choice[i],
                                                     {points.positionU[i], points.positionV[i]},
                                                     {points.directionU[i], points.directionV[i]}},
                                                    photonGuide.get());
                    started += start.has_value();
                    const bool has = (alive >> i) & 1u;
                    if (!start || !has)
                    {
                        different += start.has_value() != has;
                        continue;
                    }
                    const Vec3 origin(starts.origin.x[i], starts.origin.y[i], starts.origin.z[i]);
                    const Vec3 direction(starts.direction.x[i], starts.direction.y[i],
                                         starts.direction.z[i]);
                    const Vec3 power(starts.power.x[i], starts.power.y[i], starts.power.z[i]);
                    REQUIRE(starts.light[i] == start->light);
                    REQUIRE(starts.bin[i] == start->bin);
                    REQUIRE(glm::length(origin - start->origin) < 1e-5f);
                    REQUIRE(glm::length(direction - start->direction) < 2e-6f);
                    different +=
                        glm::length(power - start->power) > 1e-4f * glm::length(start->power);
                }
            }
            CAPTURE(int(kind), share, learnt, different);
            CHECK(started > 12000);
            // Rounding decides whether directions at a cone's rim are in the cone.
            CHECK(different <= 3);
        }
    }
}
