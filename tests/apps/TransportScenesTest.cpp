// TransportScenesTest.cpp - scenes that are hard for light transport compared with their formulas.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "apps/osgraytracebench/report/PreparedScene.h"
#include "apps/osgraytracebench/report/Reference.h"
#include "apps/osgraytracebench/report/TransportScenes.h"
#include "data/generator/Transport.h"

#include <set>

using namespace osgRayTrace;
using namespace osgRayTrace::bench;
using engine::test::Estimate;

namespace
{

constexpr int kWidth = 16;
constexpr uint32_t kSeeds = 16;

/// Returns the ratio of the mean of PATH to that of the formula, one value a seed.
Estimate ratioToFormula(const ReportScene& scene, const Placement& placement, int passes)
{
    const auto workers = std::make_shared<engine::Workers>();
    const PreparedScene prepared = prepare(scene, placement, kWidth, workers);
    const Reference reference = formulaReference(scene, kWidth, *workers);
    Estimate ratio;
    for (uint32_t seed = 1; seed <= kSeeds; ++seed)
    {
        const auto session = newSession(prepared, scene.methods.front(), seed);
        engine::StopRule rule;
        rule.passes = passes;
        renderOn(*session, rule);
        double sum = 0.0;
        for (const float value : pixelsOf(*session).rgb)
            sum += double(value) / double(kWidth * kWidth * 3);
        ratio.add(sum / reference.meanValue);
    }
    return ratio;
}

} // namespace

TEST_CASE("transport scenes: the light of two spheres is in balance", "[report]")
{
    for (const double f : {0.3, 0.1, 1e-3, 1e-5})
    {
        // All that the walls send out beyond what they reflect is emitted: L1 + L2 times the
        // share that is lost on each side, 1 - rho, is E.
        const data::PortRadiance light = data::portRadiance(f);
        CAPTURE(f);
        CHECK(light.shining - 0.8 * ((1.0 - f) * light.shining + f * light.dark) == Approx(1.0));
        CHECK(light.dark == Approx(0.8 * ((1.0 - f) * light.dark + f * light.shining)));
        CHECK(light.dark < light.shining);
    }
    CHECK(data::portRadiance(1e-5).dark == Approx(4e-5 * 5.0).epsilon(1e-3));
}

// Facets leave the spheres by 1e-4, and the port's polygon is 1e-4 smaller than its circle. With
// five comparisons at 4 standard errors, a false alarm has a probability of 5e-3 (16 seeds).
TEST_CASE("transport scenes: PATH in two spheres is that of the formula", "[report][statistics]")
{
    for (const double f : {0.3, 0.1})
    {
        const Estimate ratio = ratioToFormula(twoSpheresScene(f), atOrigin(), 64);
        CAPTURE(f, ratio.mean(), ratio.standardError());
        CHECK(ratio.standardError() < 0.02);
        CHECK(std::abs(ratio.mean() - 1.0) < 4.0 * ratio.standardError() + 1e-3);
    }
}

TEST_CASE("transport scenes: PATH under many lamps is the sum of Lambert's formulas",
          "[report][statistics]")
{
    for (const int lamps : {1, 10, 1000})
    {
        const Estimate ratio = ratioToFormula(lampFieldScene(lamps), atOrigin(), 16);
        CAPTURE(lamps, ratio.mean(), ratio.standardError());
        CHECK(ratio.standardError() < 0.02);
        CHECK(std::abs(ratio.mean() - 1.0) < 4.0 * ratio.standardError() + 1e-5);
    }
}

TEST_CASE("transport scenes: lamps of a field lie side by side and have one power together",
          "[report]")
{
    for (const int count : {1, 7, 100, 1000})
    {
        double power = 0.0;
        const std::vector<data::FieldLamp> lamps = data::fieldLamps(count);
        REQUIRE(lamps.size() == static_cast<std::size_t>(count));
        for (std::size_t i = 0; i < lamps.size(); ++i)
        {
            const osg::Vec3d normal = lamps[i].edgeU ^ lamps[i].edgeV;
            CHECK(normal.z() < 0.0);
            power += lamps[i].radiance * normal.length();
            const osg::Vec3d middle = lamps[i].corner + (lamps[i].edgeU + lamps[i].edgeV) * 0.5;
            const double reach = 0.5 * (lamps[i].edgeU.length() + lamps[i].edgeV.length());
            for (std::size_t k = i + 1; k < lamps.size(); ++k)
            {
                const osg::Vec3d other = lamps[k].corner + (lamps[k].edgeU + lamps[k].edgeV) * 0.5;
                const double otherReach = 0.5 * (lamps[k].edgeU.length() + lamps[k].edgeV.length());
                REQUIRE((other - middle).length() > reach + otherReach);
            }
        }
        CHECK(power == Approx(200.0));
    }
}

// One pass of each scene: something is lit and seen, and no sample is lost.
TEST_CASE("transport scenes: each has a name of its own, and light in its view", "[report]")
{
    std::set<std::string> names;
    const auto workers = std::make_shared<engine::Workers>();
    for (const ReportScene& scene : transportScenes())
    {
        CAPTURE(scene.name);
        CHECK(names.insert(scene.name).second);
        CHECK(!scene.quick);
        const PreparedScene prepared = prepare(scene, atOrigin(), 16, workers);
        const auto session = newSession(prepared, scene.methods.back(), 1);
        engine::StopRule rule;
        rule.passes = 2;
        const engine::RenderProgress progress = renderOn(*session, rule);
        CHECK(progress.droppedSamples == 0);
        double sum = 0.0;
        for (const float value : pixelsOf(*session).rgb)
            sum += double(value);
        // Two passes of 16 pixels find no light through the smallest ports.
        const bool tiny = scene.name.find("two-spheres-1e-0") == 0 && scene.name.back() > '2';
        if (!tiny) CHECK(sum > 0.0);
    }
}
