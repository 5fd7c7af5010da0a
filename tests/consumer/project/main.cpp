// main.cpp - renders a sphere with the installed package and checks that it is visible.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/AreaLight>
#include <osgRayTrace/PhysicalMaterial>
#include <osgRayTrace/RayTraceDrawable>
#include <osgRayTrace/RayTraceSettings>
#include <osgRayTrace/RayTracedScene>
#include <osgRayTrace/Renderer>
#include <osgRayTrace/Statistics>
#include <osgRayTrace/Version>

#include <osg/ShapeDrawable>

#include <iostream>
#include <string>

int main()
{
    if (std::string(osgRayTraceGetVersion()) != VERSION_OF_PACKAGE)
    {
        std::cerr << "library " << osgRayTraceGetVersion() << ", package " << VERSION_OF_PACKAGE
                  << '\n';
        return 1;
    }

    osg::ref_ptr<osg::ShapeDrawable> sphere = new osg::ShapeDrawable(new osg::Sphere);
    osg::ref_ptr<osgRayTrace::RayTracedScene> scene = new osgRayTrace::RayTracedScene;
    scene->addChild(sphere);

    osg::ref_ptr<osgRayTrace::Renderer> renderer = new osgRayTrace::Renderer;
    renderer->setScene(scene);
    renderer->setHomeView();
    renderer->setSize(64, 64);
    renderer->setClearColor(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
    renderer->getSettings()->setMaxPasses(2);
    if (!renderer->render())
    {
        std::cerr << renderer->getStatistics().message << '\n';
        return 1;
    }

    const osg::Vec4 centre = renderer->getColorImage()->getColor(32u, 32u);
    const osg::Vec4 corner = renderer->getColorImage()->getColor(0u, 0u);
    std::cout << "centre " << centre.r() << ", corner " << corner.r() << '\n';
    return centre.r() > 0.1f && corner.r() < 0.01f ? 0 : 1;
}
