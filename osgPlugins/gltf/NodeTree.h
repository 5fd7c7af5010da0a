// NodeTree.h - the hierarchy of a glTF file's nodes, checked to be one. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/gltf/Document.h"

#include <osg/Matrix>
#include <osg/Quat>
#include <osg/Vec3>

#include <cstddef>
#include <optional>
#include <vector>

namespace osgRayTrace::gltf
{

/// A transform of a node; animations change its parts.
struct NodeTransform
{
    osg::Vec3 translation;
    osg::Quat rotation;
    osg::Vec3 scale{1.0f, 1.0f, 1.0f};
    std::optional<osg::Matrix> matrix; ///< stands for the parts

    osg::Matrix toMatrix() const;
    bool isIdentity() const { return toMatrix().isIdentity(); }
};

/// Throws GltfError.
NodeTransform nodeTransform(const JsonPlace& node);

class NodeTree
{
public:
    static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

    /// Throws GltfError if a node has two parents, is above itself, or has more than 500 above it.
    explicit NodeTree(const Document& document);

    const std::vector<std::size_t>& children(std::size_t node) const { return _children[node]; }

    /// Returns the node above; kNone: there is none.
    std::size_t parent(std::size_t node) const { return _parents[node]; }
    std::size_t count() const { return _parents.size(); }

    /// Returns the nodes at the top of the scene that the options choose, or else the file; without
    /// scenes, all nodes that have none above.
    std::vector<std::size_t> roots(const Document& document) const;

private:
    void checkDepths(const Document& document) const;

    std::vector<std::vector<std::size_t>> _children;
    std::vector<std::size_t> _parents;
};

/// Returns the scene that the options choose, or else the file; nothing if it has no scenes.
std::optional<JsonPlace> chosenScene(const Document& document);

} // namespace osgRayTrace::gltf
