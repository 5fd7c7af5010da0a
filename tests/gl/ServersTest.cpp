// ServersTest.cpp - viewers with render servers, processes of their own, show what they show
// without. Layer: tests.
// SPDX-License-Identifier: MIT
#include "TestViewer.h"
#include "tests/Catch.h"
#include "tests/apps/RunningProgram.h"

#include <osgRayTrace/AreaLight>

#include <osg/Material>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <time.h>
#include <vector>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

/// A server at a port that is free.
struct Server
{
    explicit Server(const std::string& listen = "tcp://127.0.0.1:*")
        : program(".", {OSGRAYTRACE_TEST_SERVER, "--threads", "1", "--listen", listen})
    {
        REQUIRE(program.prints("\n"));
        const std::string& line = program.printed();
        address = line.substr(line.find("tcp://"));
        address = address.substr(0, address.find_first_of("\r\n"));
    }

    RunningProgram program;
    std::string address;
};

osg::ref_ptr<osg::Group> spheres()
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    for (int i = 0; i < 9; ++i)
        group->addChild(sphere(osg::Vec3(float(i % 3) - 1.0f, float(i / 3) - 1.0f, 0.0f), 0.45f,
                               osg::Vec4(0.1f * float(i), 0.5f, 0.9f - 0.1f * float(i), 1.0f)));
    return group;
}

/// Returns the spheres in a closed room with a lamp: light comes from everywhere.
osg::ref_ptr<osg::Group> spheresInRoom()
{
    osg::ref_ptr<osg::Group> group = spheres();
    group->getOrCreateStateSet()->setAttribute(new osg::Material);
    const auto addWall = [&](const osg::Vec3& corner, const osg::Vec3& u, const osg::Vec3& v)
    { group->addChild(osg::createTexturedQuadGeometry(corner, u, v)); };
    const osg::Vec3 low(-3.0f, -3.0f, -3.0f), high(3.0f, 3.0f, 9.0f);
    const osg::Vec3 x(6.0f, 0.0f, 0.0f), y(0.0f, 6.0f, 0.0f), z(0.0f, 0.0f, 12.0f);
    addWall(low, x, y);
    addWall(low, z, x);
    addWall(low, y, z);
    addWall(high, -y, -x);
    addWall(high, -x, -z);
    addWall(high, -z, -y);
    group->addChild(new AreaLight(osg::Vec3(-1.0f, 2.9f, 0.0f), osg::Vec3(2.0f, 0.0f, 0.0f),
                                  osg::Vec3(0.0f, 0.0f, 2.0f), osg::Vec3(9.0f, 9.0f, 9.0f)));
    return group;
}

struct View
{
    explicit View(const std::string& servers, int width = 120, int height = 100,
                  osg::Node* content = nullptr)
        : scene(tracedScene(content ? content : spheres().get())), viewer(width, height, scene)
    {
        RayTraceSettings& settings = *scene->getSettings();
        settings.setShadows(true);
        settings.setThreads(1);
        settings.setMaxPasses(4);
        settings.setServers(servers);
    }

    /// Draws frames of a view that is moved to a place, until it is at rest.
    osg::ref_ptr<osg::Image> pictureFrom(double x)
    {
        viewer.look(osg::Vec3d(x, 0.5, 6.0));
        return viewer.frames(5);
    }

    osg::ref_ptr<RayTracedScene> scene;
    TestViewer viewer;
};

/// Draws until the server has traced. Returns false if it never does.
bool drawUntilHelped(View& view, Server& server)
{
    std::atomic<bool> done{false}, helped{false};
    std::thread waits(
        [&]
        {
            helped = server.program.prints("first viewer");
            done = true;
        });
    for (int i = 0; !done; ++i)
    {
        view.pictureFrom(0.01 * (i % 100));
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    waits.join();
    return helped;
}

} // namespace

TEST_CASE("servers: equal pictures at rest with server processes, and after one is killed",
          "[servers]")
{
    View alone("none");
    Server first, second;
    View helped(first.address + "," + second.address);
    REQUIRE(drawUntilHelped(helped, first));
    REQUIRE(drawUntilHelped(helped, second));
    for (const double x : {0.0, 0.7, -0.4})
        CHECK(equal(*helped.pictureFrom(x), *alone.pictureFrom(x)));

    second.program.signal(SIGKILL);
    for (const double x : {0.1, 0.6, -0.5})
        CHECK(equal(*helped.pictureFrom(x), *alone.pictureFrom(x)));
    CHECK(second.program.wait() == -SIGKILL);

    Server successor(second.address);
    CHECK(drawUntilHelped(helped, successor));
    CHECK(equal(*helped.pictureFrom(0.2), *alone.pictureFrom(0.2)));

    first.program.signal(SIGTERM);
    CHECK(first.program.wait() == 0);
    CHECK(first.program.printed().find("ended by signal 15") != std::string::npos);
    CHECK(equal(*helped.pictureFrom(0.3), *alone.pictureFrom(0.3)));
}

TEST_CASE("servers: the keys of a server keep others away", "[servers]")
{
    char folder[] = "/tmp/osgRayTraceKeysXXXXXX";
    REQUIRE(mkdtemp(folder));
    const std::string prefix = std::string(folder) + "/key";
    RunningProgram keys(".", {OSGRAYTRACE_TEST_SERVER, "--make-keys", prefix});
    REQUIRE(keys.wait() == 0);
    RunningProgram again(".", {OSGRAYTRACE_TEST_SERVER, "--make-keys", prefix});
    CHECK(again.wait() == 1); // keys are not overwritten
    RunningProgram program(".", {OSGRAYTRACE_TEST_SERVER, "--threads", "1", "--listen",
                                 "tcp://127.0.0.1:*", "--secret-key", prefix + ".secret"});
    REQUIRE(program.prints("\n"));
    std::string address = program.printed().substr(program.printed().find("tcp://"));
    address = address.substr(0, address.find_first_of("\r\n"));

    View alone("none"), stranger(address), friendly(address + "#" + prefix + ".public");
    std::atomic<bool> done{false}, helped{false};
    std::thread waits(
        [&]
        {
            helped = program.prints("first viewer");
            done = true;
        });
    for (int i = 0; i < 40; ++i)
        stranger.pictureFrom(0.01 * i);
    CHECK_FALSE(helped);
    for (int i = 0; !done; ++i)
    {
        friendly.pictureFrom(0.01 * (i % 100));
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    waits.join();
    CHECK(helped);
    CHECK(equal(*friendly.pictureFrom(0.3), *alone.pictureFrom(0.3)));
    std::filesystem::remove_all(folder);
}

// Figures for people, of a machine that is quiet: run it by its tag.
TEST_CASE("servers: frames a second, and the frame in which a server dies", "[.measure]")
{
    using Clock = std::chrono::steady_clock;
    const auto secondsOf = [](const std::function<void()>& work)
    {
        const Clock::time_point begin = Clock::now();
        work();
        return std::chrono::duration<double>(Clock::now() - begin).count();
    };
    // Seconds of processors, which other programs on the machine do not change much.
    const auto used = [](Server* server)
    {
        clockid_t clock = CLOCK_PROCESS_CPUTIME_ID;
        timespec time{};
        if (server) clock_getcpuclockid(server->program.process(), &clock);
        clock_gettime(clock, &time);
        return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
    };
    const auto median = [](std::vector<double> values)
    {
        std::sort(values.begin(), values.end());
        return values[values.size() / 2];
    };
    constexpr int kFrames = 4, kRounds = 9;
    Server first, second;
    View local("none", 640, 480, spheresInRoom());
    View helped(first.address + "," + second.address, 640, 480, spheresInRoom());
    for (View* view : {&local, &helped})
    {
        view->scene->getSettings()->setIntegrator(RayTraceSettings::PATH);
        view->scene->getSettings()->setMaxPasses(100);
    }
    local.scene->getSettings()->setThreads(2);
    REQUIRE(drawUntilHelped(helped, first));
    REQUIRE(drawUntilHelped(helped, second));
    int step = 0;
    const auto moves = [&step](View& view)
    {
        for (int i = 0; i < kFrames; ++i)
        {
            view.viewer.look(osg::Vec3d(0.001 * ++step, 0.5, 6.0));
            view.viewer.frames(1);
        }
    };
    std::vector<double> alone, together, ratios, work;
    for (int round = 0; round < kRounds; ++round)
    {
        const double begin = used(nullptr);
        alone.push_back(secondsOf([&] { moves(local); }) / kFrames);
        const double middle = used(nullptr), servers = used(&first) + used(&second);
        together.push_back(secondsOf([&] { moves(helped); }) / kFrames);
        const double helpedWork = used(nullptr) - middle + used(&first) + used(&second) - servers;
        work.push_back((middle - begin) / helpedWork);
        ratios.push_back(alone.back() / together.back());
    }
    std::cout << "2 local threads: " << 1.0 / median(alone)
              << " frames/s; 1 thread and 2 servers: " << 1.0 / median(together)
              << "; median ratio " << median(ratios) << ", of processor time " << median(work)
              << std::endl;

    std::vector<double> before, after;
    const auto frame = [&]
    {
        helped.viewer.look(osg::Vec3d(0.001 * ++step, 0.5, 6.0));
        helped.viewer.frames(1);
    };
    for (int i = 0; i < kFrames; ++i)
        before.push_back(secondsOf(frame));
    second.program.signal(SIGKILL);
    for (int i = 0; i < kFrames; ++i)
        after.push_back(secondsOf(frame));
    std::cout << "frames [ms] before SIGKILL of a server: median " << 1e3 * median(before)
              << "; after:";
    for (const double seconds : after)
        std::cout << ' ' << 1e3 * seconds;
    std::cout << std::endl;
}
