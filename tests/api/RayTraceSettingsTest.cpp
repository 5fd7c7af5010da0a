// RayTraceSettingsTest.cpp - tests of the option table, its ranges and its environment variables.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include <osgRayTrace/RayTraceSettings>

#include <cstdlib>
#include <limits>
#include <set>

using osgRayTrace::RayTraceSettings;

namespace
{

osg::ref_ptr<RayTraceSettings> make()
{
    return new RayTraceSettings;
}

/// Sets an environment variable while the object lives.
class Environment
{
public:
    Environment(const char* name, const char* value) : _name(name) { setenv(name, value, 1); }
    ~Environment() { unsetenv(_name); }

private:
    const char* _name;
};

/// Returns a value of the option other than its default.
std::string otherValue(const RayTraceSettings::Option& option)
{
    const auto dots = option.range.find(" .. ");
    if (dots != std::string::npos)
    {
        const std::string minimum = option.range.substr(0, dots);
        return minimum != option.defaultValue ? minimum : option.range.substr(dots + 4);
    }
    const auto bar = option.range.find('|');
    const std::string first = option.range.substr(0, bar);
    return first != option.defaultValue ? first : option.range.substr(option.range.rfind('|') + 1);
}

} // namespace

TEST_CASE("settings: every option has its documented default", "[api][settings]")
{
    const auto settings = make();
    for (const auto& option : RayTraceSettings::options())
    {
        INFO(option.name);
        CHECK_FALSE(option.defaultValue.empty());
        CHECK(settings->get(option.name) == option.defaultValue);
        CHECK_FALSE(option.help.empty());
    }
    CHECK(settings->getIntegrator() == RayTraceSettings::AUTOMATIC);
    CHECK(settings->getLightSampling() == RayTraceSettings::SOBOL);
    CHECK(settings->getDebugChannel() == RayTraceSettings::NORMAL);
    CHECK(settings->getColorRule() == RayTraceSettings::AUTOMATIC_COLOR);
    CHECK(settings->getLightSamples() == 4);
    CHECK(settings->getEnvironmentSampling() == RayTraceSettings::IMPORTANCE);
    CHECK(settings->getEnvironmentSamples() == 300);
    CHECK_FALSE(settings->getCullAllRays());
    CHECK(settings->getPointRadius() == 0.0f);
    CHECK(settings->getMaxBounces() == 8);
    CHECK(settings->getShadows());
    CHECK_FALSE(settings->getHeadlightShadows());
    CHECK(settings->getMaxPasses() == 1024);
    CHECK(settings->getFrameBudget() == 33.0f);
    CHECK(settings->getDegradeWhileMoving());
    CHECK_FALSE(settings->getEqualViews());
    CHECK(settings->getPassesPerFrame() == 1);
    CHECK(settings->getThreads() == 0);
    CHECK(settings->getSeed() == 0u);
    CHECK(settings->getExposure() == 0.0f);
    CHECK(settings->getPhotonRadius() == 0.0f);
    CHECK(settings->getPhotonBeams() == 4096);
    CHECK(settings->getPhotonAlpha() == Approx(2.0f / 3.0f));
    CHECK(settings->getRadiusSchedule() == RayTraceSettings::GLOBAL);
    CHECK(settings->getPhotonGuiding());
    CHECK(settings->getDenoise() == RayTraceSettings::OFF);
    CHECK_FALSE(settings->getReproject());
    CHECK(settings->getKeepUnchanged());
}

TEST_CASE("settings: each option has a name and an environment variable of its own",
          "[api][settings]")
{
    std::set<std::string> names;
    std::set<std::string> variables;
    for (const auto& option : RayTraceSettings::options())
    {
        names.insert(option.name);
        variables.insert(option.environment);
    }
    CHECK(names.size() == RayTraceSettings::options().size());
    CHECK(variables.size() == RayTraceSettings::options().size());
    CHECK(names.count("light-samples") == 1);
    CHECK(variables.count("OSGRAYTRACE_LIGHT_SAMPLES") == 1);
}

TEST_CASE("settings: every option goes through set, get and a copy", "[api][settings]")
{
    for (const auto& option : RayTraceSettings::options())
    {
        INFO(option.name);
        const std::string value = otherValue(option);
        REQUIRE(value != option.defaultValue);

        const auto settings = make();
        REQUIRE(settings->set(option.name, value));
        CHECK(settings->get(option.name) == value);
        CHECK(settings->getModifiedCount() == 1);

        const osg::ref_ptr<RayTraceSettings> copy = new RayTraceSettings(*settings);
        CHECK(copy->get(option.name) == value);
        for (const auto& other : RayTraceSettings::options())
        {
            if (other.name != option.name) CHECK(settings->get(other.name) == other.defaultValue);
        }
    }
}

TEST_CASE("settings: every word of every choice is accepted and read back", "[api][settings]")
{
    for (const auto& option : RayTraceSettings::options())
    {
        if (option.range.find('|') == std::string::npos) continue;
        std::string rest = option.range + "|";
        while (!rest.empty())
        {
            const std::string word = rest.substr(0, rest.find('|'));
            rest.erase(0, word.size() + 1);
            INFO(option.name << " " << word);
            const auto settings = make();
            REQUIRE(settings->set(option.name, word));
            CHECK(settings->get(option.name) == word);
        }
    }
    const auto settings = make();
    CHECK(settings->set("integrator", "path"));
    CHECK(settings->getIntegrator() == RayTraceSettings::PATH);
    CHECK(settings->set("light-sampling", "UNIFORM_JITTER"));
    CHECK(settings->getLightSampling() == RayTraceSettings::UNIFORM_JITTER);
    CHECK(settings->set("color-rule", "displayReferred"));
    CHECK(settings->getColorRule() == RayTraceSettings::DISPLAY_REFERRED);
    CHECK(settings->set("debug-channel", "cost"));
    CHECK(settings->getDebugChannel() == RayTraceSettings::COST);
}

TEST_CASE("settings: sizes of single lights are checked", "[api][settings]")
{
    const auto settings = make();
    for (const char* good : {"none", "key=0.2", "key=0.2,a lamp=1e3;x=0", "a=b=1"})
    {
        CHECK(settings->set("light-sizes", good));
        CHECK(settings->getLightSizes() == good);
    }
    for (const char* bad : {"key", "key=", "=1", "key=-1", "key=nan", "key=inf", "key=1e39",
                            "key=1,", "key=1x", "key= 1", ",", "key=1,,x=2"})
    {
        INFO(bad);
        CHECK_FALSE(settings->set("light-sizes", bad));
        settings->setLightSizes(bad);
        CHECK(settings->getLightSizes() == "a=b=1");
    }
    settings->setLightSizes("");
    CHECK(settings->getLightSizes() == "none");
}

TEST_CASE("settings: a ground is none, below the model, or at a height", "[api][settings]")
{
    const auto settings = make();
    for (const char* good : {"auto", "none", "-1.5", "0", "1e3"})
    {
        CHECK(settings->set("ground", good));
        CHECK(settings->getGround() == good);
    }
    for (const char* bad : {"Auto", "nan", "inf", "1 2", "low"})
    {
        INFO(bad);
        CHECK_FALSE(settings->set("ground", bad));
        settings->setGround(bad);
        CHECK(settings->getGround() == "1e3");
    }
    settings->setGround("");
    CHECK(settings->getGround() == "none");
}

TEST_CASE("settings: names may be written in several ways", "[api][settings]")
{
    const auto settings = make();
    CHECK(settings->set("light-samples", "16"));
    CHECK(settings->set("lightSamples", "17"));
    CHECK(settings->getLightSamples() == 17);
    CHECK(settings->set("LIGHT_SAMPLES", "18"));
    CHECK(settings->get("light_samples") == "18");
    CHECK(settings->set("passes", "7"));
    CHECK(settings->getMaxPasses() == 7);
    CHECK(settings->get("max-passes") == "7");
    CHECK_FALSE(settings->set("light", "1"));
    CHECK(settings->get("light").empty());
    CHECK(settings->get("").empty());
}

TEST_CASE("settings: text that is no value changes nothing", "[api][settings]")
{
    const auto settings = make();
    for (const char* text :
         {"", "0", "4097", "-1", "4.5", "4 ", " 4", "four", "1e2", "99999999999", "+"})
    {
        INFO("'" << text << "'");
        CHECK_FALSE(settings->set("light-samples", text));
    }
    for (const char* text : {"nan", "inf", "-inf", "33", "-32.5", "1,5", "x"})
    {
        INFO("'" << text << "'");
        CHECK_FALSE(settings->set("exposure", text));
    }
    CHECK_FALSE(settings->set("seed", "-1"));
    CHECK_FALSE(settings->set("integrator", "photon"));
    CHECK_FALSE(settings->set("shadows", "maybe"));
    CHECK(settings->getModifiedCount() == 0);
    for (const auto& option : RayTraceSettings::options())
    {
        CHECK(settings->get(option.name) == option.defaultValue);
    }
}

TEST_CASE("settings: numbers and switches have their usual spellings", "[api][settings]")
{
    const auto settings = make();
    CHECK(settings->set("exposure", "-1.25"));
    CHECK(settings->getExposure() == -1.25f);
    CHECK(settings->get("exposure") == "-1.25");
    CHECK(settings->set("exposure", "+0.5"));
    CHECK(settings->getExposure() == 0.5f);
    CHECK(settings->set("seed", "4294967295"));
    CHECK(settings->getSeed() == 4294967295u);
    for (const char* off : {"0", "off", "no", "false", "FALSE"})
    {
        CHECK(settings->set("shadows", "on"));
        REQUIRE(settings->getShadows());
        CHECK(settings->set("shadows", off));
        CHECK_FALSE(settings->getShadows());
    }
}

TEST_CASE("settings: setters clamp to the documented range", "[api][settings]")
{
    const auto settings = make();
    settings->setLightSamples(0);
    CHECK(settings->getLightSamples() == 1);
    settings->setLightSamples(1 << 20);
    CHECK(settings->getLightSamples() == 4096);
    settings->setMaxBounces(-1);
    CHECK(settings->getMaxBounces() == 0);
    settings->setMaxPasses((1 << 24) + 1);
    CHECK(settings->getMaxPasses() == 1 << 24);
    settings->setPassesPerFrame(0);
    CHECK(settings->getPassesPerFrame() == 1);
    settings->setFrameBudget(-1.0f);
    CHECK(settings->getFrameBudget() == 0.0f);
    settings->setThreads(-3);
    CHECK(settings->getThreads() == 0);
    settings->setExposure(std::numeric_limits<float>::infinity());
    CHECK(settings->getExposure() == 32.0f);
    settings->setExposure(std::numeric_limits<float>::quiet_NaN());
    CHECK(settings->getExposure() == 32.0f);
    settings->setIntegrator(static_cast<RayTraceSettings::Integrator>(6));
    CHECK(settings->getIntegrator() == RayTraceSettings::DEBUG);
}

TEST_CASE("settings: only a change counts as modification", "[api][settings]")
{
    const auto settings = make();
    CHECK(settings->getModifiedCount() == 0);
    settings->setLightSamples(4);
    settings->setShadows(true);
    CHECK(settings->getModifiedCount() == 0);
    settings->setLightSamples(9);
    settings->setShadows(false);
    CHECK(settings->getModifiedCount() == 2);
}

TEST_CASE("settings: the environment gives first values, bad ones are refused", "[api][settings]")
{
    for (const auto& option : RayTraceSettings::options())
    {
        INFO(option.environment);
        const std::string value = otherValue(option);
        {
            const Environment good(option.environment.c_str(), value.c_str());
            const auto settings = make();
            CHECK(settings->get(option.name) == value);
            CHECK(settings->getModifiedCount() == 0);
        }
        if (option.name == "materials") continue; // the file may have any name
        const Environment bad(option.environment.c_str(), "no such value");
        CHECK(make()->get(option.name) == option.defaultValue);
    }
}

TEST_CASE("settings: documented defaults do not depend on the environment", "[api][settings]")
{
    const Environment samples("OSGRAYTRACE_LIGHT_SAMPLES", "64");
    for (const auto& option : RayTraceSettings::options())
    {
        if (option.name == "light-samples") CHECK(option.defaultValue == "4");
    }
    const auto settings = make();
    settings->setLightSamples(25);
    settings->setEnvironmentSampling(RayTraceSettings::STRUCTURED);
    settings->setEnvironmentSamples(50);
    const osg::ref_ptr<RayTraceSettings> copy = new RayTraceSettings(*settings);
    CHECK(copy->getLightSamples() == 25);
    CHECK(copy->getEnvironmentSampling() == RayTraceSettings::STRUCTURED);
    CHECK(copy->getEnvironmentSamples() == 50);
}
