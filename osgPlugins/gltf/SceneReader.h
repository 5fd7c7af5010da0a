// SceneReader.h - a glTF scene as a graph of OSG's nodes. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/gltf/AnimationReader.h"
#include "osgPlugins/gltf/MeshReader.h"

#include <osg/LightSource>
#include <osg/MatrixTransform>
#include <osgAnimation/Skeleton>

namespace osgRayTrace::gltf
{

/// Makes the graph of one scene: a transform that turns Y up, below it a skeleton if the file has
/// joints, below that the nodes.
class SceneReader
{
public:
    explicit SceneReader(Document& document);

    /// Throws GltfError. Is called once.
    osg::ref_ptr<osg::Node> read();

private:
    /// What the nodes above a node say.
    struct Above
    {
        osg::Matrix bone;      ///< from the coordinates of the node to the skeleton's, if a bone
        bool mirrored = false; ///< faces seem to turn the other way
    };

    /// A mesh that a skin moves: the joints place it, not its node.
    struct SkinnedMesh
    {
        std::size_t node, mesh, skin;
    };

    osg::ref_ptr<osg::Group> node(std::size_t index, const Above& above);
    osg::ref_ptr<osg::Group> emptyNode(std::size_t index, const NodeTransform& transform);
    osg::ref_ptr<osgAnimation::Bone> bone(std::size_t index, const NodeTransform& transform,
                                          const Above& above);
    std::vector<std::size_t> bonesFirst(std::vector<std::size_t> nodes) const;
    void addMesh(std::size_t index, std::size_t mesh, osg::Group& group);
    std::vector<float> weightShifts(std::size_t index, std::size_t mesh);
    void addInstances(const JsonPlace& instancing, osg::Node& mesh, osg::Group& group);
    void addAttachments(std::size_t index, osg::Group& group);
    void addSkinnedMeshes(osg::Group& skeleton);

    Document* _document;
    NodeTree _tree;
    SkinReader _skins;
    AnimationReader _animations;
    MeshReader _meshes;
    std::map<std::size_t, osgAnimation::Bone*> _bones;
    std::vector<SkinnedMesh> _skinnedMeshes;
    std::vector<osg::ref_ptr<osg::LightSource>> _lights;
};

} // namespace osgRayTrace::gltf
