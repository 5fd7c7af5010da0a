// PicturePacketTest.cpp - a renderer without a scene graph makes the passes of one that has it.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/api/RenderedRoom.h"

#include <algorithm>
#include <random>

using namespace osgRayTrace;
using namespace osgRayTrace::test;
using Catch::Matchers::Contains;

namespace
{

using Packet = std::vector<unsigned char>;

/// Returns a renderer of the room with settings of its own.
osg::ref_ptr<Renderer> tunedRenderer(osg::Node* scene, RayTraceSettings::Integrator integrator)
{
    const auto renderer = rendererOf(scene);
    renderer->getSettings()->setIntegrator(integrator);
    renderer->getSettings()->setSeed(3);
    renderer->getSettings()->setMaxBounces(5);
    renderer->getSettings()->setPhotons(2000);
    return renderer;
}

/// Returns a renderer that has nothing but the packet and a number of passes.
osg::ref_ptr<Renderer> rendererOf(const Packet& packet)
{
    const osg::ref_ptr<Renderer> renderer = new Renderer;
    renderer->getSettings()->setMaxPasses(4);
    REQUIRE(renderer->unpackPicture(packet.data(), packet.size()));
    return renderer;
}

} // namespace

TEST_CASE("picture packet: a renderer makes the same passes from it, bit by bit", "[api]")
{
    for (const auto integrator :
         {RayTraceSettings::PATH, RayTraceSettings::WHITTED, RayTraceSettings::SPPM})
    {
        CAPTURE(integrator);
        const osg::ref_ptr<osg::Group> scene = room();
        const auto renderer = tunedRenderer(scene.get(), integrator);
        const Packet packet = renderer->packPicture();
        REQUIRE_FALSE(packet.empty());
        REQUIRE(renderer->render());

        const auto other = rendererOf(packet);
        REQUIRE(other->render());
        CHECK(other->getPictureText() == renderer->getPictureText());
        CHECK(sameBytes(other->getColorImage().get(), renderer->getColorImage().get()));
        CHECK(sameBytes(other->getChannelImage("depth").get(),
                        renderer->getChannelImage("depth").get()));
        CHECK((other->getPassSums().low == renderer->getPassSums().low));
        CHECK(other->getStatistics().triangles == renderer->getStatistics().triangles);
    }
}

TEST_CASE("picture packet: a graph takes its place again", "[api]")
{
    const osg::ref_ptr<osg::Group> scene = room();
    const auto renderer = tunedRenderer(scene.get(), RayTraceSettings::PATH);
    const auto other = rendererOf(renderer->packPicture());
    REQUIRE(other->render());
    const osg::ref_ptr<osg::Group> empty = new osg::Group;
    other->setScene(empty.get());
    REQUIRE(other->render());
    CHECK(other->getStatistics().triangles == 0);
    other->setScene(nullptr);
    CHECK_FALSE(other->render());
}

TEST_CASE("picture packet: what cannot be packed is said", "[api]")
{
    const osg::ref_ptr<osg::Group> scene = room();
    const auto renderer = tunedRenderer(scene.get(), RayTraceSettings::PATH);
    renderer->setShutter([](double) {});
    CHECK(renderer->packPicture().empty());
    CHECK_THAT(renderer->getStatistics().message, Contains("shutter"));
    renderer->setShutter({});
    renderer->setScene(nullptr);
    CHECK(renderer->packPicture().empty());
    CHECK_THAT(renderer->getStatistics().message, Contains("no scene"));
}

TEST_CASE("picture packet: damaged bytes and those of another build are refused", "[api]")
{
    const osg::ref_ptr<osg::Group> scene = room();
    const auto renderer = tunedRenderer(scene.get(), RayTraceSettings::PATH);
    const Packet packet = renderer->packPicture();
    const osg::ref_ptr<Renderer> other = new Renderer;
    const auto takes = [&other](const Packet& bytes)
    { return other->unpackPicture(bytes.data(), bytes.size()); };

    Packet foreign = packet;
    const std::string name = "osgRayTrace ";
    const auto version = std::search(foreign.begin(), foreign.end(), name.begin(), name.end());
    REQUIRE(version != foreign.end());
    version[static_cast<std::ptrdiff_t>(name.size())] = '9';
    CHECK_FALSE(takes(foreign));
    CHECK_THAT(other->getStatistics().message,
               Contains("the scene comes from osgRayTrace 9") && Contains("this process is"));

    for (std::size_t size = 0; size < packet.size(); size += 1 + packet.size() / 200)
    {
        CAPTURE(size);
        CHECK_FALSE(takes(Packet(packet.begin(), packet.begin() + std::ptrdiff_t(size))));
        CHECK_FALSE(other->getStatistics().message.empty());
    }
    CHECK_FALSE(other->render()); // nothing of all that was taken

    std::mt19937 random(1);
    for (int i = 0; i < 300; ++i)
    {
        Packet changed = packet;
        for (int bits = 0; bits < 4; ++bits)
            changed[random() % changed.size()] ^= static_cast<unsigned char>(1u << (random() % 8));
        // Numbers that differ are another picture, and all others are refused.
        if (!takes(changed)) CHECK_FALSE(other->getStatistics().message.empty());
    }
    REQUIRE(takes(packet));
}
