// liveEdits.cpp - edits a scene while it is ray traced, with the keys m, c, d and a.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/RayTracedScene>

#include <osg/Material>
#include <osg/MatrixTransform>
#include <osg/ShapeDrawable>
#include <osgGA/TrackballManipulator>
#include <osgViewer/Viewer>

#include <functional>
#include <map>

// This handler runs the function that belongs to a key.
struct KeyHandler : osgGA::GUIEventHandler
{
    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter&) override
    {
        const bool pressed = event.getEventType() == osgGA::GUIEventAdapter::KEYDOWN;
        if (pressed && edits.count(event.getKey())) edits[event.getKey()]();
        return false;
    }
    std::map<int, std::function<void()>> edits;
};

int main()
{
    osg::ref_ptr<osgRayTrace::RayTracedScene> scene = new osgRayTrace::RayTracedScene;
    scene->getSettings()->setIntegrator(osgRayTrace::RayTraceSettings::PATH);
    osg::Geometry* floor = osg::createTexturedQuadGeometry({-3, -3, 0}, {6, 0, 0}, {0, 6, 0});
    scene->addChild(floor);
    osg::MatrixTransform* ball = new osg::MatrixTransform;
    ball->addChild(new osg::ShapeDrawable(new osg::Sphere({-1, 0, 1}, 1)));
    scene->addChild(ball);
    osg::Material* material = new osg::Material;
    ball->getOrCreateStateSet()->setAttribute(material);

    // Edit in event handlers or update callbacks. osgRayTrace finds each change by itself, converts
    // only what has changed, and begins a new picture.
    osg::ref_ptr<KeyHandler> keys = new KeyHandler;
    keys->edits['m'] = [=] { ball->setMatrix(osg::Matrix::translate(1, 0, 0)); };
    keys->edits['c'] = [=] { material->setDiffuse(osg::Material::FRONT, osg::Vec4(1, 0, 0, 1)); };
    keys->edits['a'] = [=] { scene->addChild(new osg::ShapeDrawable(new osg::Box({2, 0, 1}, 1))); };
    keys->edits['d'] = [=]
    {
        auto* vertices = static_cast<osg::Vec3Array*>(floor->getVertexArray());
        (*vertices)[0].z() += 1.0f;
        vertices->dirty(); // as for OpenGL, OpenSceneGraph must be told
        floor->dirtyBound();
    };

    osg::ref_ptr<osgGA::TrackballManipulator> trackball = new osgGA::TrackballManipulator;
    trackball->setHomePosition({0, -12, 5}, {0, 0, 0.5}, {0, 0, 1});
    osgViewer::Viewer viewer;
    viewer.setLightingMode(osg::View::SKY_LIGHT); // a sky light casts shadows, a headlight none
    viewer.setSceneData(scene);
    viewer.setCameraManipulator(trackball);
    viewer.addEventHandler(keys);
    return viewer.run();
}
