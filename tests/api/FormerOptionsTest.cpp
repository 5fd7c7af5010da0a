// FormerOptionsTest.cpp - options are read by their former names, with one message.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/Messages.h"

#include <osgRayTrace/RayTraceSettings>

#include <cstdlib>

using osgRayTrace::RayTraceSettings;
using osgRayTrace::engine::test::Messages;

TEST_CASE("former options: aim-at-views stands for photon-guiding", "[api][settings]")
{
    const Messages messages;
    const osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;
    REQUIRE(settings->getPhotonGuiding());
    for (const char* name : {"aim-at-views", "AimAtViews", "aim_at_views"})
    {
        INFO(name);
        settings->setPhotonGuiding(true);
        REQUIRE(settings->set(name, "false"));
        CHECK_FALSE(settings->getPhotonGuiding());
        CHECK(settings->get(name) == "false");
        CHECK_FALSE(settings->set(name, "maybe"));
    }
    CHECK(messages.timesSaid("aim-at-views is called photon-guiding now") == 1);
    CHECK(messages.timesSaid("\n") == 1);
}

TEST_CASE("former options: the environment's former names count if the new ones are not set",
          "[api][settings]")
{
    const Messages messages;
    setenv("OSGRAYTRACE_AIM_AT_VIEWS", "false", 1);
    for (int i = 0; i < 2; ++i)
    {
        const osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;
        CHECK_FALSE(settings->getPhotonGuiding());
    }
    setenv("OSGRAYTRACE_PHOTON_GUIDING", "true", 1);
    const osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;
    CHECK(settings->getPhotonGuiding());
    unsetenv("OSGRAYTRACE_PHOTON_GUIDING");
    unsetenv("OSGRAYTRACE_AIM_AT_VIEWS");
    CHECK(messages.timesSaid("OSGRAYTRACE_AIM_AT_VIEWS is called OSGRAYTRACE_PHOTON_GUIDING") == 1);
}

TEST_CASE("former options: the table lists the former name beside the new one alone",
          "[api][settings]")
{
    int count = 0;
    for (const RayTraceSettings::Option& option : RayTraceSettings::options())
    {
        CHECK(option.name != "aim-at-views");
        if (option.formerName.empty()) continue;
        ++count;
        CHECK(option.name == "photon-guiding");
        CHECK(option.formerName == "aim-at-views");
    }
    CHECK(count == 1);
}
