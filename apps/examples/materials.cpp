// materials.cpp - shows chrome, gold, plastic and glass in the light of a sky.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/EnvironmentLight>
#include <osgRayTrace/PhysicalMaterial>
#include <osgRayTrace/RayTracedScene>

#include <osg/ShapeDrawable>
#include <osgDB/ReadFile>
#include <osgGA/TrackballManipulator>
#include <osgViewer/Viewer>

// A PhysicalMaterial is a state attribute: any StateSet can hold one, and children inherit it.
osgRayTrace::PhysicalMaterial& addShape(osg::Group& parent, osg::Shape* shape)
{
    osg::ref_ptr<osg::TessellationHints> fine = new osg::TessellationHints;
    fine->setDetailRatio(3.0f);
    osg::ref_ptr<osg::Node> node = new osg::ShapeDrawable(shape, fine);
    parent.addChild(node);
    auto* material = new osgRayTrace::PhysicalMaterial;
    node->getOrCreateStateSet()->setAttribute(material);
    return *material;
}

int main(int argc, char** argv)
{
    // The picture holds the whole sky by longitude and latitude in linear radiance (.exr, .hdr).
    osg::ref_ptr<osg::Image> sky = osgDB::readRefImageFile(argc > 1 ? argv[1] : "sky.exr");
    if (!sky) return 1; // OpenSceneGraph has printed the reason

    osg::ref_ptr<osgRayTrace::RayTracedScene> scene = new osgRayTrace::RayTracedScene;
    scene->addChild(new osgRayTrace::EnvironmentLight(sky));
    addShape(*scene, new osg::Box({0, 0, -1.1f}, 12, 8, 0.2f)).setBaseColor({0.5f, 0.5f, 0.5f});

    osgRayTrace::PhysicalMaterial& chrome = addShape(*scene, new osg::Sphere({-3.3f, 0, 0}, 1));
    chrome.setMetallic(1.0f); // the base colour of a metal is its reflectance
    chrome.setRoughness(0.0f);

    osgRayTrace::PhysicalMaterial& gold = addShape(*scene, new osg::Sphere({-1.1f, 0, 0}, 1));
    gold.setBaseColor({1.0f, 0.77f, 0.34f});
    gold.setMetallic(1.0f);
    gold.setRoughness(0.4f);

    osgRayTrace::PhysicalMaterial& plastic = addShape(*scene, new osg::Sphere({1.1f, 0, 0}, 1));
    plastic.setBaseColor({0.7f, 0.02f, 0.02f});
    plastic.setRoughness(0.1f);

    osgRayTrace::PhysicalMaterial& glass = addShape(*scene, new osg::Sphere({3.3f, 0, 0}, 1));
    glass.setTransmission(1.0f);
    glass.setRoughness(0.0f);

    osg::ref_ptr<osgGA::TrackballManipulator> trackball = new osgGA::TrackballManipulator;
    trackball->setHomePosition({0, -18, 5}, {0, 0, 0}, {0, 0, 1});
    osgViewer::Viewer viewer;
    viewer.setLightingMode(osg::View::NO_LIGHT); // the sky is enough
    viewer.setSceneData(scene);
    viewer.setCameraManipulator(trackball);
    return viewer.run();
}
