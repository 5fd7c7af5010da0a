// picking.cpp - prints the name of the object that is clicked, which one ray finds.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/RayIntersector>
#include <osgRayTrace/RayTracedScene>

#include <osg/ShapeDrawable>
#include <osgGA/TrackballManipulator>
#include <osgViewer/Viewer>

#include <iostream>

struct PickHandler : osgGA::GUIEventHandler
{
    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& viewer) override
    {
        if (event.getEventType() != osgGA::GUIEventAdapter::PUSH) return false;

        // A RayIntersector is an osgUtil::LineSegmentIntersector, and is used in the same way.
        osg::ref_ptr<osgRayTrace::RayIntersector> ray = new osgRayTrace::RayIntersector(
            osgUtil::Intersector::PROJECTION, event.getXnormalized(), event.getYnormalized());
        osgUtil::IntersectionVisitor visitor(ray);
        viewer.asView()->getCamera()->accept(visitor);
        if (ray->containsIntersections())
        {
            const osgUtil::LineSegmentIntersector::Intersection hit = ray->getFirstIntersection();
            const osg::Vec3d point = hit.getWorldIntersectPoint();
            std::cout << hit.nodePath.back()->getName() << " at " << point.x() << ' ' << point.y()
                      << ' ' << point.z() << std::endl;
        }
        else
            std::cout << "nothing" << std::endl;
        return false; // the camera manipulator needs the event, too
    }
};

// Drawables are nodes in OpenSceneGraph 3.6; the one that is hit is the last of the node path.
osg::ref_ptr<osg::Node> shape(const char* name, osg::Shape* shape, const osg::Vec4& color)
{
    osg::ref_ptr<osg::ShapeDrawable> drawable = new osg::ShapeDrawable(shape);
    drawable->setName(name);
    drawable->setColor(color);
    return drawable;
}

int main()
{
    osg::ref_ptr<osgRayTrace::RayTracedScene> scene = new osgRayTrace::RayTracedScene;
    scene->addChild(shape("floor", new osg::Box(osg::Vec3(), 8, 8, 0.1f), osg::Vec4(1, 1, 1, 1)));
    scene->addChild(shape("ball", new osg::Sphere(osg::Vec3(-2, 0, 1), 1), osg::Vec4(1, 0, 0, 1)));
    scene->addChild(shape("box", new osg::Box(osg::Vec3(2, 0, 1), 2), osg::Vec4(0, 0, 1, 1)));

    osg::ref_ptr<osgGA::TrackballManipulator> trackball = new osgGA::TrackballManipulator;
    trackball->setHomePosition({0, -16, 6}, {0, 0, 0.5}, {0, 0, 1});
    osgViewer::Viewer viewer;
    viewer.setLightingMode(osg::View::SKY_LIGHT); // a sky light casts shadows, a headlight none
    viewer.setSceneData(scene);
    viewer.setCameraManipulator(trackball);
    viewer.addEventHandler(new PickHandler);
    return viewer.run();
}
