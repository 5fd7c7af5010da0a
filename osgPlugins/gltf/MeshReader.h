// MeshReader.h - meshes as geodes, shared by the nodes that use them. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/gltf/SkinReader.h"
#include "osgPlugins/gltf/SurfaceReader.h"
#include "osgPlugins/gltf/VertexReader.h"

#include <osg/Geode>
#include <osgAnimation/MorphGeometry>

namespace osgRayTrace::gltf
{

class MeshReader
{
public:
    explicit MeshReader(Document& document);

    /// Returns whether a mesh has morph targets, whose weights belong to the node.
    bool isMorphed(std::size_t mesh) const;

    /// Returns a mesh: the same geode for all nodes. Throws GltfError.
    osg::ref_ptr<osg::Geode> shared(std::size_t mesh);

    /// Returns a mesh for one node alone: morphed by the node's weights, or the mesh's own, and
    /// moved by a skin unless it is null. shifts: what is added to the weight of each target, and
    /// taken from the mesh at rest, so that osgAnimation finds no weight below 0, which it leaves
    /// out.
    osg::ref_ptr<osg::Geode> own(std::size_t mesh, const JsonPlace& node, const Skin* skin,
                                 const std::vector<float>& shifts);

    /// Returns the weights of a node's morph targets, as far as the file has some.
    std::vector<float> weights(std::size_t mesh, const JsonPlace& node) const;

    AccessorReader& accessors() { return _vertices.accessors(); }

private:
    /// A primitive as it stands in the file, with its surface.
    struct Primitive
    {
        JsonPlace place;
        Vertices vertices;
        const Surface* surface;
    };

    const std::vector<Primitive>& primitives(std::size_t mesh);
    std::optional<std::size_t> materialOf(const JsonPlace& primitive) const;
    osg::ref_ptr<osg::Geode> emptyGeode(std::size_t mesh) const;
    osg::ref_ptr<osgAnimation::MorphGeometry> morphed(const Primitive& primitive,
                                                      const std::vector<float>& weights,
                                                      const std::vector<float>& shifts) const;

    Document* _document;
    VertexReader _vertices;
    SurfaceReader _surfaces;
    std::size_t _variants = 0;           ///< of KHR_materials_variants
    std::optional<std::size_t> _variant; ///< that is taken
    std::map<std::size_t, std::vector<Primitive>> _primitives;
    std::map<std::size_t, osg::ref_ptr<osg::Geode>> _shared;
};

} // namespace osgRayTrace::gltf
