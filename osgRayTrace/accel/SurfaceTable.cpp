// SurfaceTable.cpp - collects pointers to the arrays of meshes. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/SurfaceTable.h"

namespace osgRayTrace::engine
{

namespace
{

/// Returns a pointer to the data of an array, null if the array is empty.
template <class T> const T* dataOf(const SharedArray<T>& array)
{
    return array.empty() ? nullptr : array.data();
}

MeshArrays arraysOf(const Mesh& mesh)
{
    return {dataOf(mesh.triangles), dataOf(mesh.positions),
            dataOf(mesh.normals),   dataOf(mesh.uvs),
            dataOf(mesh.uvs1),      dataOf(mesh.rs),
            dataOf(mesh.rs1),       dataOf(mesh.colors),
            dataOf(mesh.tangents),  mesh.moreUvs.empty() ? nullptr : &mesh.moreUvs};
}

} // namespace

SurfaceTable::SurfaceTable(const Scene& scene, const SurfaceTable* previous,
                           const Scene* previousScene)
    : _instances(scene.instances.data()), _size(scene.instances.size())
{
    const auto& meshes = scene.meshes;
    _meshes.reserve(meshes.size());
    for (std::size_t i = 0; i < meshes.size(); ++i)
    {
        const bool known =
            previous && i < previousScene->meshes.size() && previousScene->meshes[i] == meshes[i];
        _meshes.push_back(known ? previous->_meshes[i] : arraysOf(*meshes[i]));
    }
}

} // namespace osgRayTrace::engine
