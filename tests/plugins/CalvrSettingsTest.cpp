// CalvrSettingsTest.cpp - CalVR's configuration and menu as settings, tested without CalVR.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgPlugins/calvr/MenuChoices.h"
#include "osgPlugins/calvr/PluginConfig.h"

#include <map>

using namespace osgRayTrace::calvr;
using osgRayTrace::RayTraceSettings;

namespace
{

using Elements = std::vector<std::pair<std::string, std::string>>;

/// Reads the elements as CalVR does: if several have one name, the first one's value counts.
PluginConfig read(const Elements& elements, RayTraceSettings& settings)
{
    std::vector<std::string> names;
    std::map<std::string, std::string> values;
    for (const auto& [name, value] : elements)
    {
        names.push_back(name);
        values.emplace(name, value);
    }
    return readConfig(
        names, [&](const std::string& name) { return values.at(name); }, settings);
}

std::string allOf(const RayTraceSettings& settings)
{
    std::string text;
    for (const RayTraceSettings::Option& option : RayTraceSettings::options())
        text += option.name + "=" + settings.get(option.name) + "\n";
    return text;
}

/// Returns the name of the element for an option: LightSamples for "light-samples".
std::string elementName(const std::string& option)
{
    std::string name;
    bool upper = true;
    for (const char c : option)
    {
        if (c != '-') name += upper && c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
        upper = c == '-';
    }
    return name;
}

} // namespace

TEST_CASE("CalVR configuration: every option is an element", "[calvr]")
{
    const osg::ref_ptr<RayTraceSettings> defaults = new RayTraceSettings;
    for (const RayTraceSettings::Option& option : RayTraceSettings::options())
    {
        CAPTURE(option.name);
        const osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;
        const PluginConfig config =
            read({{elementName(option.name), defaults->get(option.name)}}, *settings);
        CHECK(config.complaints.empty());
        CHECK(allOf(*settings) == allOf(*defaults));
    }

    const osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;
    const PluginConfig config = read({{"Integrator", "sppm"},
                                      {"LightSamples", "9"},
                                      {"Shadows", "off"},
                                      {"PhotonRadius", "2.5"},
                                      {"Seed", "77"},
                                      {"Threads", "3"}},
                                     *settings);
    CHECK(config.complaints.empty());
    CHECK(settings->getIntegrator() == RayTraceSettings::SPPM);
    CHECK(settings->getLightSamples() == 9);
    CHECK_FALSE(settings->getShadows());
    CHECK(settings->getPhotonRadius() == 2.5f);
    CHECK(settings->getSeed() == 77u);
    CHECK(settings->getThreads() == 3);
}

TEST_CASE("CalVR configuration: the plugin's own elements", "[calvr]")
{
    const osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;
    CHECK(read({}, *settings).trace);
    CHECK(read({}, *settings).clusterBudget == 33.0);
    CHECK_FALSE(read({{"Trace", "off"}}, *settings).trace);
    CHECK_FALSE(read({{"Trace", "False"}}, *settings).trace);
    CHECK(read({{"Trace", "ON"}}, *settings).trace);
    CHECK(read({{"ClusterBudget", "16.5"}}, *settings).clusterBudget == 16.5);
}

TEST_CASE("CalVR configuration: what is no option or no value is complained of and changes nothing",
          "[calvr]")
{
    const osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;
    const std::string before = allOf(*settings);
    const PluginConfig config = read({{"Integrater", "path"},
                                      {"LightSamples", "many"},
                                      {"Trace", "maybe"},
                                      {"ClusterBudget", "0"},
                                      {"Seed", ""},
                                      {"MaxBounces", "-1"},
                                      {"LightSamples", "16"}},
                                     *settings);
    CHECK(allOf(*settings) == before);
    CHECK(config.trace);
    CHECK(config.clusterBudget == 33.0);
    REQUIRE(config.complaints.size() == 6); // one for the two elements LightSamples
    CHECK(config.complaints[0] == "there is no option 'Integrater'");
    CHECK(config.complaints[1] == "'LightSamples' cannot be 'many'");
}

TEST_CASE("cluster settings: all nodes have the master's, each its own threads", "[calvr]")
{
    const osg::ref_ptr<RayTraceSettings> master = new RayTraceSettings,
                                         slave = new RayTraceSettings;
    master->setIntegrator(RayTraceSettings::PPM);
    master->setSeed(4711);
    master->setPhotonRadius(0.1f);
    master->setLightSizes("key=0.2,fill=1");
    master->setThreads(2);
    slave->setSeed(5);
    slave->setThreads(64);
    slave->setExposure(3.0f);

    PluginConfig ofMaster, ofSlave;
    ofMaster.trace = false;
    ofMaster.clusterBudget = 16.0;
    makeEqualOnAllNodes(*master, ofMaster);
    makeEqualOnAllNodes(*slave, ofSlave);
    CHECK(takeSharedSettings(sharedSettings(*master, ofMaster), *slave, ofSlave).empty());
    CHECK_FALSE(ofSlave.trace);
    CHECK(ofSlave.clusterBudget == 33.0); // each node has its own
    CHECK(slave->getThreads() == 64);
    CHECK_FALSE(slave->getPhotonGuiding());
    CHECK(slave->getEqualViews());
    CHECK(slave->getFrameBudget() == 33.0f); // each node has its own
    CHECK(master->getFrameBudget() == 16.0f);
    slave->setThreads(2);
    slave->setFrameBudget(16.0f);
    CHECK(allOf(*slave) == allOf(*master));
}

TEST_CASE("cluster settings: what the configuration wants otherwise is overruled, and named in one "
          "sentence",
          "[calvr]")
{
    const auto overruled = [](const Elements& elements)
    {
        const osg::ref_ptr<RayTraceSettings> settings = wallSettings();
        const PluginConfig config = read(elements, *settings);
        CHECK(config.complaints.empty());
        const std::string sentence = makeEqualOnAllNodes(*settings, config);
        CHECK(settings->getPresentation() == RayTraceSettings::FRAME_LOCKED);
        CHECK_FALSE(settings->getPhotonGuiding());
        CHECK(settings->getEqualViews());
        CHECK(settings->getFrameBudget() == float(config.clusterBudget));
        return sentence;
    };
    CHECK(overruled({}).empty());
    CHECK(overruled({{"ClusterBudget", "50"}, {"Photons", "1024"}}).empty());
    // A setting that has the required value is not reported.
    CHECK(overruled({{"Presentation", "frame-locked"}, {"PhotonGuiding", "off"}}).empty());
    CHECK(overruled({{"ClusterBudget", "20"}, {"FrameBudget", "20"}}).empty());

    CHECK(overruled({{"Presentation", "background"}}) ==
          "in a cluster Presentation 'background' is overruled: nodes show the same frame");
    const std::string all = overruled({{"Presentation", "background"},
                                       {"FrameBudget", "16"},
                                       {"PhotonGuiding", "on"},
                                       {"equal_views", "off"},
                                       {"PassesPerFrame", "3"}});
    for (const char* part :
         {"Presentation 'background'", "FrameBudget '16' is overruled: ClusterBudget holds, 33 ms",
          "PhotonGuiding 'true'", "EqualViews 'false'", "PassesPerFrame '3'"})
    {
        CAPTURE(all, part);
        CHECK(all.find(part) != std::string::npos);
    }
    CHECK(all.find('\n') == std::string::npos);
}

TEST_CASE("CalVR configuration: walls are equal unless it says otherwise", "[calvr]")
{
    const osg::ref_ptr<RayTraceSettings> settings = wallSettings();
    CHECK(settings->getEqualViews());
    read({{"EqualViews", "off"}}, *settings);
    CHECK_FALSE(settings->getEqualViews());
    CHECK_FALSE(read({{"ClusterBudget", "60001"}}, *settings).complaints.empty());
}

TEST_CASE("cluster settings: what another version says is left out and told", "[calvr]")
{
    const osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;
    PluginConfig config;
    const auto complaints = takeSharedSettings(
        "trace=perhaps\nseed=9\nwarp=1\nphotons=-4\nrubbish\nthreads=7\n", *settings, config);
    CHECK(config.trace);
    CHECK(complaints.size() == 5);
    CHECK(settings->getSeed() == 9u);
    CHECK(settings->getThreads() == 0);
}

TEST_CASE("menu: each line sets what it says, and is then the chosen one", "[calvr]")
{
    const std::vector<MenuChoice> choices = menuChoices();
    REQUIRE(choices.size() == 4);
    for (const MenuChoice& choice : choices)
    {
        CAPTURE(choice.title);
        CHECK(choice.entries.size() >= 3);
        const osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;
        for (size_t i = 0; i < choice.entries.size(); ++i)
        {
            CAPTURE(choice.entries[i].label);
            choose(choice.entries[i], *settings);
            CHECK(chosenEntry(choice, *settings) == static_cast<int>(i));
            for (const auto& [option, value] : choice.entries[i].values)
                CHECK(settings->get(option) == value);
        }
    }
}

TEST_CASE("menu: the defaults are chosen lines, other values are none", "[calvr]")
{
    const osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;
    for (const MenuChoice& choice : menuChoices())
    {
        CAPTURE(choice.title);
        CHECK(chosenEntry(choice, *settings) >= 0);
    }
    settings->setPhotons(12345);
    settings->setMaxBounces(7);
    const std::vector<MenuChoice> choices = menuChoices();
    CHECK(chosenEntry(choices[2], *settings) == -1);
    CHECK(chosenEntry(choices[3], *settings) == -1);
}
