// SceneDataHook.cpp - setSceneData that puts a RayTracedScene above the scene. Layer: apps.
// SPDX-License-Identifier: MIT
//
// Preloaded, this definition of osgViewer::View::setSceneData is found before that of libosgViewer,
// which it calls.
#include "RunReport.h"
#include "ToggleKey.h"

#include <osgRayTrace/SceneLights>

#include "osgRayTrace/base/NeverDestroyed.h"

#include <osg/NodeVisitor>
#include <osg/Notify>
#include <osgViewer/View>

#include <dlfcn.h>

#include <cstdlib>
#include <exception>
#include <map>
#include <mutex>
#include <set>

namespace osgRayTrace::app
{

namespace
{

using SetSceneData = void (*)(osgViewer::View*, osg::Node*);

SetSceneData original()
{
    static const auto function = reinterpret_cast<SetSceneData>(
        dlsym(RTLD_NEXT, "_ZN9osgViewer4View12setSceneDataEPN3osg4NodeE"));
    return function;
}

/// Returns whether the program ray traces the scene itself.
bool holdsTracedScene(osg::Node& node)
{
    struct Find : osg::NodeVisitor
    {
        Find() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
        void apply(osg::Group& group) override
        {
            found = found || dynamic_cast<RayTracedScene*>(&group);
            if (!found && visited.insert(&group).second) traverse(group); // one path is enough
        }
        bool found = false;
        std::set<osg::ref_ptr<osg::Group>> visited;
    } find;
    node.accept(find);
    return find.found;
}

/// Returns one RayTracedScene for each scene: views that show the same scene share it.
osg::ref_ptr<RayTracedScene> tracedScene(osg::Node& node)
{
    static std::mutex mutex;
    static engine::NeverDestroyed<std::map<osg::Node*, osg::observer_ptr<RayTracedScene>>> scenes;
    std::lock_guard<std::mutex> lock(mutex);
    osg::observer_ptr<RayTracedScene>& known = (*scenes)[&node];
    osg::ref_ptr<RayTracedScene> scene;
    if (known.lock(scene) && scene->containsNode(&node)) return scene;
    scene = new RayTracedScene;
    scene->setName("osgraytrace-run");
    scene->addChild(&node);
    SceneLights lights;
    lights.readVariables();
    const std::string problem = lights.addTo(*scene);
    if (!problem.empty()) OSG_WARN << "osgRayTrace: " << problem << std::endl;
    known = scene;
    reportAtExit(*scene);
    return scene;
}

int toggleKey()
{
    const char* name = std::getenv("OSGRAYTRACE_TOGGLE_KEY");
    if (!name || !*name) return osgGA::GUIEventAdapter::KEY_F9;
    if (const auto key = keyFromName(name)) return *key;
    OSG_WARN << "osgRayTrace: OSGRAYTRACE_TOGGLE_KEY is F1 to F12 or a character, not '" << name
             << "'" << std::endl;
    return osgGA::GUIEventAdapter::KEY_F9;
}

void sayWhatIsTraced()
{
    static std::once_flag said;
    std::call_once(said,
                   []
                   {
                       OSG_NOTICE << "osgRayTrace: what views show is ray traced; cameras with "
                                     "scenes of their own are not"
                                  << std::endl;
                   });
}

void addToggleKey(osgViewer::View& view, RayTracedScene* scene)
{
    for (const osg::ref_ptr<osgGA::EventHandler>& handler : view.getEventHandlers())
    {
        const auto* known = dynamic_cast<const ToggleKey*>(handler.get());
        if (known && known->isFor(scene)) return;
    }
    view.addEventHandler(new ToggleKey(scene, toggleKey()));
}

/// Returns the node that the view has to show; the node itself if it cannot be ray traced.
osg::ref_ptr<osg::Node> shownFor(osgViewer::View& view, osg::Node* node)
{
    if (!node || holdsTracedScene(*node)) return node;
    try
    {
        const osg::ref_ptr<RayTracedScene> scene = tracedScene(*node);
        addToggleKey(view, scene.get());
        sayWhatIsTraced();
        return scene;
    }
    catch (const std::exception& error)
    {
        OSG_WARN << "osgRayTrace: a scene is not ray traced: " << error.what() << std::endl;
        return node;
    }
}

} // namespace

} // namespace osgRayTrace::app

__attribute__((visibility("default"))) void osgViewer::View::setSceneData(osg::Node* node)
{
    const osg::ref_ptr<osg::Node> kept = node; // many programs leave the only reference to the view
    osgRayTrace::app::original()(this, osgRayTrace::app::shownFor(*this, node).get());
}
