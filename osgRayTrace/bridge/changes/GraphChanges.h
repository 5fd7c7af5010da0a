// GraphChanges.h - the changes of a scene graph since it was converted. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/changes/ConversionReason.h"
#include "osgRayTrace/bridge/common/ObjectIdentity.h"
#include "osgRayTrace/bridge/graph/CullOutcome.h"

#include <osg/ClipNode>
#include <osg/Geometry>
#include <osg/Light>
#include <osg/Matrixd>
#include <osg/Vec4>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace osgRayTrace::engine
{

/// Names one path to a geometry.
struct ChangedUse
{
    const osg::Geometry* geometry = nullptr;
    uint32_t use = 0;  ///< number of the path among those to the geometry, in traversal order
    uint32_t uses = 0; ///< number of all paths to the geometry
};

/// Names a use whose transforms changed.
struct MovedUse : ChangedUse
{
    osg::Matrixd worldFromLocal;
};

/// Names a use that has other state, or other arrays.
struct StateChange : MovedUse
{
    bool looksOnly = false; ///< only values of osg::Material and osg::Fog are others
    osg::NodePath path;     ///< path from the first node that was found to the geometry
};

/// Names nodes that came or went.
struct GraphSplice
{
    std::vector<ChangedUse> removed;   ///< numbers and uses as they were before
    osg::NodePath removedFrom;         ///< path to the parent of the node that went
    std::vector<Kept<osg::Node>> gone; ///< keeps alive the geometries of removed
    osg::NodePath added;               ///< path to the node that came; empty: none came
    /// Uses below the node that came, in traversal order, numbered as they are then.
    std::vector<ChangedUse> uses;
};

/// Names a clip node and the place of its planes.
struct PlacedClip
{
    const osg::ClipNode* node = nullptr;
    osg::Matrixd sceneFromPlanes;
};

/// Names proxies of a cull traversal that came or went.
struct CullSplice
{
    osg::NodePath path;              ///< from the root to the node whose cull traversal shows them
    std::vector<ChangedUse> removed; ///< each the only use of its geometry
    std::vector<CulledLeaf> gone;    ///< keeps alive the geometries of removed
    std::vector<CulledLeaf> added;
    std::vector<const osg::Geometry*> left;    ///< geometries that OSG draws now, without proxies
    std::map<std::string, int64_t> countsMore; ///< what the report counts more; fewer: below 0
};

/// Names an unwatched subtree, see UnwatchedSubtree.
struct ChangedSubtree
{
    ConversionCause cause = ConversionCause::None; ///< cause if it cannot be redone alone
    osg::NodePath path; ///< from the root, or from the first node that was found
};

/// Names what of a view's conditions has changed without the graph.
struct ViewChange
{
    osg::Vec4 clearColor;                 ///< as in ViewingConditions
    osg::ref_ptr<const osg::Light> light; ///< null only if there was none before
};

/// Lists the changes of a graph by pointers into it, which are valid as long as nobody changes the
/// graph. The numbers of uses in moved, deformed and stateChanges are those after all splices.
struct GraphChanges
{
    /// True: the graph must be converted again, as the lists below do not tell all changes.
    bool convert = false;
    bool record = false;              ///< true: the graph must be recorded again as well
    ConversionReason reason;          ///< why convert is set: the first reason that was found
    std::vector<GraphSplice> splices; ///< in the order in which they are to be made
    std::vector<CullSplice> culled;
    std::vector<MovedUse> moved;
    /// Geometries with other positions, normals or primitives.
    std::vector<const osg::Geometry*> deformed;
    std::vector<StateChange> stateChanges;
    /// Unwatched subtrees with other content, place or state, each by the path to it or to a node
    /// in it. They are collected again after all other changes.
    std::vector<ChangedSubtree> subtrees;
    bool lights = false; ///< true: values of lights of any kind changed
    /// All clip nodes that are watched, in traversal order, if planes of one that cut what is in
    /// the scene have changed; else empty.
    std::vector<PlacedClip> clips;
    std::optional<ViewChange> view;

    bool none() const { return !view && noneInGraph(); }
    bool isOfTheView() const { return view && noneInGraph(); }

private:
    bool noneInGraph() const
    {
        return !convert && splices.empty() && culled.empty() && moved.empty() && deformed.empty() &&
               stateChanges.empty() && subtrees.empty() && !lights && clips.empty();
    }
};

} // namespace osgRayTrace::engine
