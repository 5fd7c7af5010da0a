// LeafChecker.cpp - preloaded with osgraytrace-run, this library names the drawables of a scene
// that are neither traced nor drawn by OSG. Layer: tests.
// SPDX-License-Identifier: MIT
//
// In the frame OSGRAYTRACE_TEST_FRAMES - 1, a clone of the view's cull visitor runs over the
// children of each RayTracedScene as if there were no ray tracing. Each leaf of its render stages
// must be among the leaves of what OSG draws beside the traced picture, or be a use of a geometry
// that is traced. A whole conversion must report what the program's own scene reports, whose edits
// may be of many frames. The counts are added to the file "<OSGRAYTRACE_TEST_PICTURES>.leaves".
#include "osgRayTrace/bridge/common/FlatMatrix.h"
#include "osgRayTrace/bridge/common/SceneRoot.h"
#include "osgRayTrace/bridge/common/ViewingConditions.h"
#include "osgRayTrace/bridge/convert/SceneConverter.h"
#include "osgRayTrace/bridge/graph/GraphCollector.h"
#include "osgRayTrace/bridge/graph/RasterizedParts.h"
#include "osgRayTrace/bridge/update/ViewMasks.h"
#include "tests/clients/CullLeaves.h"

#include <osgRayTrace/RayTracedScene>

#include <osgUtil/CullVisitor>

#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;

namespace
{

using Places = std::map<const osg::Drawable*, std::vector<osg::Matrixd>>;

/// masks: traversal masks of all views.
ConversionInput inputOf(const ViewingConditions& conditions, const std::set<unsigned int>& masks,
                        osg::Node& root)
{
    ConversionInput input;
    input.root = &root;
    input.eye = conditions.eye;
    input.view = conditions.view;
    input.pass = conditions.pass;
    input.traversalMask = 0;
    for (const unsigned int mask : masks)
        input.traversalMask |= mask;
    if (masks.size() > 1) input.viewMasks.assign(masks.begin(), masks.end());
    input.viewLight = conditions.light;
    input.viewLightInEyeSpace = conditions.lightInEyeSpace;
    input.inheritedState = conditions.inheritedState;
    input.rasterizesRest = true;
    input.picks = true;
    return input;
}

bool close(const osg::Matrixd& a, const osg::Matrixd& b)
{
    double size = 1.0, difference = 0.0;
    for (int i = 0; i < 16; ++i)
    {
        size = std::max(size, std::abs(a.ptr()[i]));
        difference = std::max(difference, std::abs(a.ptr()[i] - b.ptr()[i]));
    }
    return difference <= 1e-5 * size;
}

template <class Key>
bool holds(const std::map<Key, std::vector<osg::Matrixd>>& places, const Key& key,
           const osg::Matrixd& place)
{
    const auto found = places.find(key);
    return found != places.end() &&
           std::any_of(found->second.begin(), found->second.end(),
                       [&](const osg::Matrixd& other) { return close(other, place); });
}

/// Returns the primitive sets of a drawable that are not traced, or nothing for what is no
/// geometry.
std::set<const osg::PrimitiveSet*> setsWithoutTriangles(const osg::Drawable& drawable)
{
    std::set<const osg::PrimitiveSet*> sets;
    const osg::Geometry* geometry = drawable.asGeometry();
    for (unsigned int i = 0; geometry && i < geometry->getNumPrimitiveSets(); ++i)
    {
        const osg::PrimitiveSet* set = geometry->getPrimitiveSet(i);
        if (set->getNumIndices() > 0 && !hasTriangles(*set)) sets.insert(set);
    }
    return sets;
}

/// Returns whether a drawable is of no node: each cull traversal may have another one.
bool isMadeInCull(const osg::Drawable& drawable)
{
    return drawable.getNumParents() == 0;
}

bool isEmpty(const osg::Drawable& drawable)
{
    const osg::Geometry* geometry = drawable.asGeometry();
    if (!geometry) return false;
    for (const osg::ref_ptr<osg::PrimitiveSet>& set : geometry->getPrimitiveSetList())
        if (set && set->getNumIndices() > 0) return false;
    return true;
}

std::string nameOf(const osg::Node& node)
{
    std::string name = node.getName().empty() ? node.className() : node.getName();
    return node.getNumParents() > 0 ? nameOf(*node.getParent(0)) + '/' + name : name;
}

/// What becomes of the leaves of a scene.
struct Tally
{
    std::size_t leaves = 0, traced = 0, drawn = 0, empty = 0, otherPasses = 0;
    std::vector<std::string> lost;
    std::vector<std::string> stale; ///< counts of the report that a whole conversion does not give
};

struct Found
{
    Places traced; ///< places of what is traced, by drawable
    Places drawn;  ///< places of what OSG draws
    std::map<const osg::PrimitiveSet*, std::vector<osg::Matrixd>> drawnSets;
    std::map<std::string, std::vector<osg::Matrixd>> madeInCull; ///< by class
    std::set<const osg::Drawable*> boxes; ///< with which OSG draws volumes that are traced
};

Found find(const CollectedGraph& graph, const Leaves& drawn, const osg::Matrixd& viewFromScene)
{
    Found found;
    for (const CollectedGeometry& geometry : graph.geometries)
        for (const GeometryUse& use : geometry.uses)
        {
            if (use.proxy) continue;
            const osg::Drawable* drawable = geometry.geometry.get();
            if (isMadeInCull(*drawable))
                found.madeInCull[drawable->className()].push_back(use.engineFromLocal *
                                                                  viewFromScene);
            if (use.path != NodeTree::kNone)
                if (const osg::Drawable* own = graph.paths.node(use.path).asDrawable())
                    drawable = own; // the use of a posed figure is a copy
            found.traced[drawable].push_back(use.engineFromLocal * viewFromScene);
        }
    for (const Leaf& leaf : drawn)
    {
        found.drawn[leaf.drawable.get()].push_back(leaf.modelView);
        if (isMadeInCull(*leaf.drawable))
            found.madeInCull[leaf.drawable->className()].push_back(leaf.modelView);
        if (const osg::Geometry* geometry = leaf.drawable->asGeometry())
            for (const osg::ref_ptr<osg::PrimitiveSet>& set : geometry->getPrimitiveSetList())
                found.drawnSets[set.get()].push_back(leaf.modelView);
    }
    return found;
}

/// Returns whether OSG draws these sets of a leaf, if only in a copy of the drawable.
bool drawsSets(const Found& found, const std::set<const osg::PrimitiveSet*>& sets,
               const osg::Matrixd& place)
{
    return std::all_of(sets.begin(), sets.end(),
                       [&](const osg::PrimitiveSet* set)
                       { return holds(found.drawnSets, set, place); });
}

void judge(const Leaf& leaf, const Found& found, Tally& tally)
{
    ++tally.leaves;
    const osg::Drawable& drawable = *leaf.drawable;
    const bool drawnAlike =
        isMadeInCull(drawable) &&
        holds(found.madeInCull, std::string(drawable.className()), leaf.modelView);
    if (drawnAlike || holds(found.drawn, leaf.drawable.get(), leaf.modelView))
    {
        ++tally.drawn;
        return;
    }
    if (found.boxes.count(&drawable))
    {
        ++tally.traced;
        return;
    }
    if (isEmpty(drawable) || !placingMatrix(leaf.modelView, 0.0))
    {
        ++tally.empty;
        return;
    }
    if (leaf.ownStage && (found.traced.count(&drawable) || found.drawn.count(&drawable)))
    {
        ++tally.otherPasses; // as of shadow maps
        return;
    }
    const std::set<const osg::PrimitiveSet*> rest = setsWithoutTriangles(drawable);
    const osg::Geometry* geometry = drawable.asGeometry();
    const bool allRest = !rest.empty() && rest.size() == geometry->getNumPrimitiveSets();
    if ((allRest || holds(found.traced, leaf.drawable.get(), leaf.modelView)) &&
        drawsSets(found, rest, leaf.modelView))
    {
        ++tally.traced;
        return;
    }
    tally.lost.push_back(std::string(leaf.ownStage ? "in a camera of its own: " : "") +
                         drawable.libraryName() + "::" + drawable.className() + " " +
                         nameOf(drawable));
}

void write(const Tally& tally)
{
    const char* pictures = std::getenv("OSGRAYTRACE_TEST_PICTURES");
    std::ofstream file(std::string(pictures ? pictures : "picture") + ".leaves", std::ios::app);
    file << "leaves " << tally.leaves << "\ntraced " << tally.traced << "\ndrawn " << tally.drawn
         << "\nempty " << tally.empty << "\nother-passes " << tally.otherPasses << "\nlost "
         << tally.lost.size() << '\n';
    for (const std::string& name : tally.lost)
        file << "lost-leaf " << name << '\n';
    file << "stale " << tally.stale.size() << '\n';
    for (const std::string& count : tally.stale)
        file << "stale-count " << count << '\n';
}

/// Returns the report of a conversion of the whole scene, by a converter that has seen the images
/// of earlier frames: textures give them up once they are drawn. It outlives the program's threads.
ConversionCounts countsOf(const RayTracedScene& scene, ConversionInput input)
{
    static std::mutex mutex;
    static auto* converters = new std::map<const RayTracedScene*, SceneConverter>;
    const std::lock_guard<std::mutex> lock(mutex);
    input.origin = input.eye; // far from it, floats have no room for small triangles
    return (*converters)[&scene].convert(input).counts;
}

/// Returns the counts of a program's scene that differ from those of a whole conversion, of all
/// that is drawn: as traced, as left to OSG, or as left out and named.
std::vector<std::string> staleCounts(const RayTracedScene& scene, ConversionCounts fresh)
{
    ConversionCounts counts = scene.getDrawable()->getStatistics().conversion;
    std::set<std::string> keys;
    for (const ConversionCounts* all : {&fresh, &counts})
        for (const auto& [key, count] : *all)
            for (const char* prefix : {"converted.geometry", "converted.instance",
                                       "converted.culled", "traced.", "rasterized.", "not-traced."})
                if (key.rfind(prefix, 0) == 0) keys.insert(key);
    std::vector<std::string> stale;
    for (const std::string& key : keys)
        if (fresh[key] != counts[key])
            stale.push_back(key + " " + std::to_string(counts[key]) + " instead of " +
                            std::to_string(fresh[key]));
    return stale;
}

/// Holds what a conversion of a scene needs in a view.
struct Situation
{
    Situation(RayTracedScene& scene, osgUtil::CullVisitor& visitor,
              const std::set<unsigned int>& masks)
        : root(new SceneRoot(&scene)), conditions(viewingConditions(visitor))
    {
        if (!conditions.view || !visitor.getFrameStamp()) return;
        conditions.pass = cullPass(visitor, nullptr);
        isKnown = conditions.pass->isClone;
        input = inputOf(conditions, masks, *root);
    }
    ~Situation() { root->detach(); }
    Situation(const Situation&) = delete;
    Situation& operator=(const Situation&) = delete;

    osg::ref_ptr<SceneRoot> root;
    ViewingConditions conditions;
    ConversionInput input;
    bool isKnown = false;
};

void check(RayTracedScene& scene, osgUtil::CullVisitor& visitor,
           const std::set<unsigned int>& masks)
{
    Situation now(scene, visitor, masks);
    if (!now.isKnown) return;
    const auto begin = [&](osgUtil::CullVisitor& clone)
    {
        clone.pushOntoNodePath(&scene);
        if (scene.getStateSet()) clone.pushStateSet(scene.getStateSet());
    };
    const auto plainLeaves = [&]
    {
        return leavesOf(*now.conditions.pass, now.conditions,
                        [&](osgUtil::CullVisitor& clone)
                        {
                            begin(clone);
                            for (unsigned int i = 0; i < scene.getNumChildren(); ++i)
                                scene.getChild(i)->accept(clone);
                        });
    };
    // A callback may set the matrix of its transform, which has been taken by then: it holds from
    // the second traversal of a frame on, as that of FlightGear's spins.
    plainLeaves();
    SoftwareVertices vertices;
    DrawableTriangles triangles;
    const TextureConverter textures;
    RuleCaches rules;
    ConversionReport report;
    GraphCollector collector(now.input, vertices, triangles, textures, rules, report);
    now.root->accept(collector);
    const CollectedGraph graph = collector.take();

    const Leaves plain = plainLeaves();
    const Leaves drawn = leavesOf(*now.conditions.pass, now.conditions,
                                  [&](osgUtil::CullVisitor& clone)
                                  {
                                      begin(clone);
                                      cullParts(graph.rasterized, clone);
                                  });
    Found found = find(graph, drawn, now.conditions.view->viewFromWorld);
    for (const CollectedTile& tile : graph.lights.tiles)
        for (const Leaf& leaf :
             leavesOf(*now.conditions.pass, now.conditions,
                      [&](osgUtil::CullVisitor& clone)
                      { const_cast<osgVolume::VolumeTile&>(*tile.tile).accept(clone); }))
            found.boxes.insert(leaf.drawable.get());
    Tally tally;
    for (const Leaf& leaf : plain)
        judge(leaf, found, tally);
    tally.stale = staleCounts(scene, countsOf(scene, now.input));
    write(tally);
}

/// Lets the checker's converter see the images of this frame.
void watch(RayTracedScene& scene, osgUtil::CullVisitor& visitor)
{
    const Situation now(scene, visitor, {visitor.getTraversalMask()});
    if (now.isKnown) countsOf(scene, now.input);
}

unsigned int frameToCheck()
{
    const char* frames = std::getenv("OSGRAYTRACE_TEST_FRAMES");
    return unsigned(std::max(2, frames ? std::atoi(frames) : 30)) - 1;
}

/// Returns the traversal masks with which views look at a scene now if this view is to be checked:
/// once for each mask, in the frame to check or in the first one behind it.
std::set<unsigned int> masksIfDue(const RayTracedScene& scene, osgUtil::CullVisitor& visitor)
{
    struct Checked
    {
        std::mutex mutex;
        std::map<const RayTracedScene*, ViewMasks> masks;
        std::map<const RayTracedScene*, std::set<unsigned int>> checked;
    };
    static auto* state = new Checked; // outlives the program's threads
    const auto mask = visitor.getTraversalMask();
    const osg::FrameStamp* frameStamp = visitor.getFrameStamp();
    const bool late = frameStamp && frameStamp->getFrameNumber() >= frameToCheck();
    const std::lock_guard<std::mutex> lock(state->mutex);
    auto& masks = state->masks[&scene];
    masks.record(visitor.getCurrentCamera(), mask, frameStamp);
    if (!late || !scene.getEnabled() || !state->checked[&scene].insert(mask).second) return {};
    const auto inUse = masks.inUse(frameStamp);
    return {inUse.begin(), inUse.end()};
}

} // namespace

__attribute__((visibility("default"))) void
osgRayTrace::RayTracedScene::traverse(osg::NodeVisitor& visitor)
{
    using Traverse = void (*)(RayTracedScene*, osg::NodeVisitor&);
    static const auto traverse = reinterpret_cast<Traverse>(
        dlsym(RTLD_NEXT, "_ZN11osgRayTrace14RayTracedScene8traverseERN3osg11NodeVisitorE"));
    if (osgUtil::CullVisitor* cull = visitor.asCullVisitor())
    {
        const std::set<unsigned int> masks = masksIfDue(*this, *cull);
        if (masks.empty())
            watch(*this, *cull);
        else
            check(*this, *cull, masks);
    }
    traverse(this, visitor);
}
