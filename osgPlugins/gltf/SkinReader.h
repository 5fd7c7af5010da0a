// SkinReader.h - skins of glTF as bones and influences of osgAnimation. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/gltf/NodeTree.h"
#include "osgPlugins/gltf/VertexReader.h"

#include <osgAnimation/Bone>
#include <osgAnimation/RigGeometry>

#include <map>
#include <set>
#include <string>
#include <vector>

namespace osgRayTrace::gltf
{

/// A skin whose joints are bones of the scene.
struct Skin
{
    std::vector<osg::ref_ptr<osgAnimation::Bone>> bones; ///< one for each joint
};

class SkinReader
{
public:
    SkinReader(Document& document, const NodeTree& tree);

    /// Returns whether a node has to be a bone: it is a joint, or above one.
    bool isBone(std::size_t node) const { return _isBone[node]; }
    bool hasBones() const { return _hasBones; }

    /// Returns a name that no other bone has, as osgAnimation finds bones by their names. The
    /// number is appended until that is so.
    std::string newName(std::string wanted, std::size_t number);

    /// Returns a skin. bones: those that the nodes of the scene have become. A joint that another
    /// skin has bound in another place gets a further bone, which stays with it.
    const Skin& read(std::size_t skin, const std::map<std::size_t, osgAnimation::Bone*>& bones,
                     AccessorReader& accessors);

private:
    osgAnimation::Bone* boundBone(osgAnimation::Bone& joint, const osg::Matrix& inverseBind,
                                  const JsonPlace& place);

    Document* _document;
    std::vector<bool> _isBone;
    bool _hasBones = false;
    std::set<std::string> _names; ///< of all bones
    std::map<std::size_t, Skin> _skins;
    std::map<osgAnimation::Bone*, std::vector<osgAnimation::Bone*>> _bound; ///< those in use
};

/// Returns a geometry that follows a skin. Throws GltfError if a vertex has a joint that the skin
/// has not.
osg::ref_ptr<osgAnimation::RigGeometry> riggedGeometry(osg::Geometry& source,
                                                       const Vertices& vertices, const Skin& skin,
                                                       const JsonPlace& primitive);

} // namespace osgRayTrace::gltf
