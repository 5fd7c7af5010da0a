// FlatNormals.h - triangles with facet normals of their own. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/gltf/VertexReader.h"

namespace osgRayTrace::gltf
{

/// Returns whether a primitive is made of triangles.
bool isOfTriangles(const osg::PrimitiveSet& primitives);

/// Returns the triangles of vertices, which have no normals, with three vertices for each and the
/// normal of its plane, as glTF 2.0, sect. 3.7.2.1, wants it; tangents are left out. Throws
/// GltfError with the place if the triangles are too many.
Vertices withFlatNormals(const Vertices& vertices, Document& document, const JsonPlace& place);

} // namespace osgRayTrace::gltf
