// AnimationReader.h - animations of glTF as those of osgAnimation. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/gltf/Accessor.h"
#include "osgPlugins/gltf/NodeTree.h"

#include <osgAnimation/Animation>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/UpdateMatrixTransform>

#include <map>
#include <string>
#include <vector>

namespace osgRayTrace::gltf
{

/// Returns the name by which channels find the transform of a node.
std::string transformTarget(std::size_t node);

/// Returns the name by which channels find the weights of a node's morph targets.
std::string weightsTarget(std::size_t node);

class AnimationReader
{
public:
    AnimationReader(Document& document, const NodeTree& tree);

    /// Returns whether an animation moves a node, or changes the weights of its mesh.
    bool movesNode(std::size_t node) const { return _movesNode[node]; }
    bool changesWeights(std::size_t node) const { return _changesWeights[node]; }

    /// Returns for each morph target of a node's mesh the least weight that clips give it, or less.
    std::vector<float> lowestWeights(std::size_t node, AccessorReader& accessors) const;

    /// Adds to the weights that clips give the morph targets of a node's mesh.
    void shiftWeights(std::size_t node, const std::vector<float>& shifts)
    {
        _shifts[node] = shifts;
    }

    /// Returns the manager that plays the first animation from the first update traversal on; null
    /// if the file has none.
    osg::ref_ptr<osgAnimation::BasicAnimationManager> read(AccessorReader& accessors);

private:
    osg::ref_ptr<osgAnimation::Animation> animation(const JsonPlace& place,
                                                    AccessorReader& accessors) const;

    Document* _document;
    std::vector<bool> _movesNode, _changesWeights;
    std::map<std::size_t, std::vector<float>> _shifts; ///< of weights, by node
};

/// Gives a callback the parts of a transform, which channels of transformTarget() change.
void setStack(const NodeTransform& transform, osgAnimation::UpdateMatrixTransform& callback);

} // namespace osgRayTrace::gltf
