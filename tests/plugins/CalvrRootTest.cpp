// CalvrRootTest.cpp - a node that is put under ray tracing and taken out again, tested without
// CalVR.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgPlugins/calvr/TracedRoot.h"

#include <osgRayTrace/Statistics>

#include <osg/ClipNode>
#include <osg/Geode>
#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osgUtil/CullVisitor>

#include <cmath>

using namespace osgRayTrace::calvr;
using osgRayTrace::RayTraceSettings;
using osgRayTrace::Statistics;

namespace
{

/// Holds the part of CalVR's graph that matters here: room > [transform > scale > objects, menu,
/// light].
struct Room
{
    Room()
    {
        room->addChild(transform);
        room->addChild(menu);
        room->addChild(source);
        transform->addChild(scale);
        scale->addChild(before);
        scale->addChild(objects);
        scale->addChild(after);
        quad->addDrawable(osg::createTexturedQuadGeometry(osg::Vec3(), osg::Vec3(1.0f, 0.0f, 0.0f),
                                                          osg::Vec3(0.0f, 1.0f, 0.0f)));
        objects->addChild(quad);
        objects->setCullingActive(false);
        objects->getOrCreateStateSet()->setMode(GL_LIGHT0,
                                                osg::StateAttribute::ON); // CalVR's room sets it
        light->setLightNum(0);
        light->setPosition(osg::Vec4(0.0f, -1e4f, 1e4f, 1.0f));
        source->setLight(light);
        transform->setMatrix(osg::Matrix::translate(10.0, 20.0, 30.0));
        scale->setMatrix(osg::Matrix::scale(100.0, 100.0, 100.0));
    }

    osg::Matrixd objectsFromRoom() const
    {
        return osg::Matrixd::inverse(scale->getMatrix() * transform->getMatrix());
    }

    const osg::ref_ptr<osg::Group> room = new osg::Group, menu = new osg::Group;
    const osg::ref_ptr<osg::Group> before = new osg::Group, after = new osg::Group;
    const osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform,
                                             scale = new osg::MatrixTransform;
    const osg::ref_ptr<osg::ClipNode> objects = new osg::ClipNode;
    const osg::ref_ptr<osg::Geode> quad = new osg::Geode;
    const osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    const osg::ref_ptr<osg::Light> light = new osg::Light;
};

Statistics convert(TracedRoot& root, unsigned int frame)
{
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    stamp->setFrameNumber(frame);
    root.scene().getDrawable()->updateScene(stamp);
    return root.scene().getDrawable()->getStatistics();
}

} // namespace

TEST_CASE("traced root: on, it is between the node and its parents; off, the graph is as it was",
          "[calvr]")
{
    Room room;
    const osg::ref_ptr<osg::Group> other = new osg::Group;
    other->addChild(new osg::Group);
    other->addChild(room.objects);
    const osg::Node::ParentList parents = room.objects->getParents();
    TracedRoot root(new RayTraceSettings);
    for (int round = 0; round < 3; ++round)
    {
        root.switchOn(room.objects);
        root.switchOn(room.objects); // a second call does nothing
        CHECK(root.isOn());
        CHECK(room.scale->getChild(1) == &root.scene());
        CHECK(other->getChild(1) == &root.scene());
        CHECK(room.objects->getNumParents() == 1);
        CHECK(room.objects->getParent(0) == &root.scene());
        CHECK_FALSE(root.scene().getCullingActive());

        root.switchOff();
        root.switchOff();
        CHECK_FALSE(root.isOn());
        CHECK(room.objects->getParents() == parents);
        CHECK(room.scale->getNumChildren() == 3);
        CHECK(room.scale->getChild(1) == room.objects);
        CHECK(other->getChild(1) == room.objects);
        CHECK(root.scene().getNumParents() == 0);
    }
}

TEST_CASE("traced root: its end restores the graph, too", "[calvr]")
{
    Room room;
    {
        TracedRoot root(new RayTraceSettings);
        root.switchOn(room.objects);
        root.updateLights(*room.room, room.objectsFromRoom());
    }
    CHECK(room.scale->getChild(1) == room.objects);
    CHECK(room.objects->getNumParents() == 1);
    CHECK(room.source->getNumParents() == 1);
}

TEST_CASE("traced root: no node and a node without parents are let be", "[calvr]")
{
    TracedRoot root(new RayTraceSettings);
    root.switchOn(nullptr);
    CHECK_FALSE(root.isOn());
    const osg::ref_ptr<osg::Group> alone = new osg::Group;
    root.switchOn(alone);
    CHECK_FALSE(root.isOn());
    CHECK(alone->getNumParents() == 0);
}

TEST_CASE("traced root: switched off and on again, nothing is converted", "[calvr]")
{
    Room room;
    TracedRoot root(new RayTraceSettings);
    root.switchOn(room.objects);
    root.updateLights(*room.room, room.objectsFromRoom());
    const Statistics first = convert(root, 1);
    REQUIRE(first.ok);
    CHECK(first.triangles == 2);
    CHECK(first.conversions == 1);

    root.switchOff();
    root.switchOn(room.objects);
    root.updateLights(*room.room, room.objectsFromRoom());
    const Statistics second = convert(root, 2);
    CHECK(second.conversions == 1);
    CHECK(second.convertedMeshes == first.convertedMeshes);
}

TEST_CASE("room lights: a light beside the objects lights them, and moves with navigation without "
          "a conversion",
          "[calvr]")
{
    Room room;
    TracedRoot root(new RayTraceSettings);
    root.switchOn(room.objects);
    root.updateLights(*room.room, room.objectsFromRoom());
    CHECK(root.scene().getNumChildren() == 2);
    const Statistics first = convert(root, 1);
    CHECK(first.lights == 1);

    room.transform->setMatrix(osg::Matrix::rotate(0.3, 0.0, 0.0, 1.0) *
                              osg::Matrix::translate(5.0, 6.0, 7.0));
    root.updateLights(*room.room, room.objectsFromRoom());
    const auto* copy = dynamic_cast<const osg::LightSource*>(root.scene().getChild(1));
    REQUIRE(copy);
    const osg::Vec4d back = osg::Vec4d(copy->getLight()->getPosition()) *
                            (room.scale->getMatrix() * room.transform->getMatrix());
    CHECK((back - osg::Vec4d(room.light->getPosition())).length() < 0.01); // of 14142, in float
    const Statistics second = convert(root, 2);
    CHECK(second.conversions == 1);
    CHECK(second.patches == first.patches + 1);
    CHECK(convert(root, 3).patches == second.patches);

    room.light->setDiffuse(osg::Vec4(0.5f, 0.25f, 0.125f, 1.0f));
    root.updateLights(*room.room, room.objectsFromRoom());
    CHECK(copy->getLight()->getDiffuse() == room.light->getDiffuse());

    const osg::ref_ptr<osg::LightSource> second2 = new osg::LightSource;
    second2->setLight(new osg::Light(3));
    room.room->addChild(second2);
    root.updateLights(*room.room, room.objectsFromRoom());
    CHECK(root.scene().getNumChildren() == 3);
    room.room->removeChild(room.source);
    room.room->removeChild(second2);
    root.updateLights(*room.room, room.objectsFromRoom());
    CHECK(root.scene().getNumChildren() == 1);
}

TEST_CASE("room lights: a lamp in millimetres lights a model in metres alike", "[calvr]")
{
    const osg::ref_ptr<osg::Light> lamp = new osg::Light;
    osg::Light& light = *lamp;
    light.setPosition(osg::Vec4(1000.0f, 2000.0f, 500.0f, 1.0f));
    light.setDirection(osg::Vec3(0.0f, 0.6f, -0.8f));
    light.setConstantAttenuation(0.5f);
    light.setLinearAttenuation(2e-3f);
    light.setQuadraticAttenuation(3e-6f);
    const osg::Matrixd roomFromObjects = osg::Matrixd::scale(1000.0, 1000.0, 1000.0) *
                                         osg::Matrixd::rotate(0.7, 1.0, 2.0, 3.0) *
                                         osg::Matrixd::translate(100.0, 200.0, 300.0);
    const osg::ref_ptr<osg::Light> placed =
        placedLight(light, osg::Matrixd::inverse(roomFromObjects));

    const osg::Vec3d point(0.25, -0.5, 0.75); // of the model [m]
    const osg::Vec4 position = placed->getPosition();
    const double metres = (osg::Vec3d(position.x(), position.y(), position.z()) - point).length();
    const osg::Vec3d inRoom = point * roomFromObjects;
    const double millimetres = (osg::Vec3d(1000.0, 2000.0, 500.0) - inRoom).length();
    CHECK(metres * 1000.0 == Approx(millimetres).epsilon(1e-6));
    const double here = placed->getConstantAttenuation() + placed->getLinearAttenuation() * metres +
                        placed->getQuadraticAttenuation() * metres * metres;
    const double there = 0.5 + 2e-3f * millimetres + 3e-6f * millimetres * millimetres;
    CHECK(here == Approx(there).epsilon(1e-6));

    const osg::Vec3d direction =
        osg::Matrixd::transform3x3(osg::Vec3d(placed->getDirection()), roomFromObjects);
    CHECK((direction / 1000.0 - osg::Vec3d(light.getDirection())).length() < 1e-6);
    CHECK(placed->getDirection().length() == Approx(1.0).epsilon(1e-6));

    const osg::ref_ptr<osg::Light> sun = new osg::Light;
    osg::Light& distant = *sun;
    distant.setPosition(osg::Vec4(0.0f, 0.0f, 1.0f, 0.0f));
    const osg::Vec4 towards =
        placedLight(distant, osg::Matrixd::inverse(roomFromObjects))->getPosition();
    CHECK(towards.w() == 0.0f);
    const osg::Vec3d away = osg::Matrixd::transform3x3(
        osg::Vec3d(towards.x(), towards.y(), towards.z()), roomFromObjects);
    CHECK((away - osg::Vec3d(0.0, 0.0, 1.0)).length() < 1e-6);
}

TEST_CASE("room lights: a headlight stays with the eye", "[calvr]")
{
    Room room;
    room.source->setReferenceFrame(osg::LightSource::ABSOLUTE_RF);
    TracedRoot root(new RayTraceSettings);
    root.switchOn(room.objects);
    root.updateLights(*room.room, room.objectsFromRoom());
    const auto* copy = dynamic_cast<const osg::LightSource*>(root.scene().getChild(1));
    REQUIRE(copy);
    CHECK(copy->getReferenceFrame() == osg::LightSource::ABSOLUTE_RF);
    CHECK(copy->getLight()->getPosition() == room.light->getPosition());
}
