// SceneReader.cpp - turns nodes into OSG's. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/SceneReader.h"

#include "osgPlugins/gltf/Attachments.h"
#include "osgPlugins/gltf/Extras.h"
#include "osgPlugins/gltf/RigBounds.h"

#include <osg/FrontFace>
#include <osgAnimation/UpdateBone>

#include <algorithm>

namespace osgRayTrace::gltf
{

namespace
{

constexpr int kFirstLight = 1; ///< viewers have their own light at 0
constexpr std::uint64_t kNodeBytes = 512;

bool mirrors(const osg::Matrix& m)
{
    const osg::Vec3d x(m(0, 0), m(0, 1), m(0, 2)), y(m(1, 0), m(1, 1), m(1, 2)),
        z(m(2, 0), m(2, 1), m(2, 2));
    return (x ^ y) * z < 0.0;
}

/// glTF turns the winding of faces with the sign of the transform; OpenGL does not.
void setWinding(bool mirrored, osg::Node& node)
{
    node.getOrCreateStateSet()->setAttributeAndModes(new osg::FrontFace(
        mirrored ? osg::FrontFace::CLOCKWISE : osg::FrontFace::COUNTER_CLOCKWISE));
}

} // namespace

SceneReader::SceneReader(Document& document)
    : _document(&document),
      _tree(document),
      _skins(document, _tree),
      _animations(document, _tree),
      _meshes(document)
{
}

std::vector<std::size_t> SceneReader::bonesFirst(std::vector<std::size_t> nodes) const
{
    std::stable_partition(nodes.begin(), nodes.end(),
                          [this](std::size_t node) { return _skins.isBone(node); });
    return nodes;
}

osg::ref_ptr<osgAnimation::Bone>
SceneReader::bone(std::size_t index, const NodeTransform& transform, const Above& above)
{
    const std::string name = _document->element("nodes", index).textOr("name", "");
    const osg::ref_ptr<osgAnimation::Bone> made =
        new osgAnimation::Bone(_skins.newName(name, index));
    const osg::Matrix local = transform.toMatrix();
    made->setMatrix(local);
    made->setMatrixInSkeletonSpace(local * above.bone);
    const osg::ref_ptr<osgAnimation::UpdateBone> callback =
        new osgAnimation::UpdateBone(transformTarget(index));
    setStack(transform, *callback);
    made->setUpdateCallback(callback.get());
    _bones[index] = made.get();
    return made;
}

osg::ref_ptr<osg::Group> SceneReader::emptyNode(std::size_t index, const NodeTransform& transform)
{
    const bool moves = _animations.movesNode(index);
    if (!moves && transform.isIdentity()) return new osg::Group;
    const osg::ref_ptr<osg::MatrixTransform> made = new osg::MatrixTransform(transform.toMatrix());
    if (!moves) return made;
    const osg::ref_ptr<osgAnimation::UpdateMatrixTransform> callback =
        new osgAnimation::UpdateMatrixTransform(transformTarget(index));
    setStack(transform, *callback);
    made->setUpdateCallback(callback.get());
    made->setDataVariance(osg::Object::DYNAMIC);
    return made;
}

osg::ref_ptr<osg::Group> SceneReader::node(std::size_t index, const Above& above)
{
    const JsonPlace place = _document->element("nodes", index);
    _document->take(kNodeBytes, place);
    NodeTransform transform = nodeTransform(place);
    if (transform.matrix && _animations.movesNode(index))
    {
        osg::Vec3d t, s;
        osg::Quat unused;
        transform.matrix->decompose(t, transform.rotation, s, unused);
        transform.translation = t;
        transform.scale = s;
        transform.matrix.reset();
    }
    const osg::Matrix local = transform.toMatrix();
    const bool isBone = _skins.isBone(index);
    osg::ref_ptr<osg::Group> group;
    if (isBone)
        group = bone(index, transform, above);
    else
    {
        group = emptyNode(index, transform);
        group->setName(place.textOr("name", ""));
    }
    setExtras(place, *group);
    const Above below{local * above.bone, above.mirrored != mirrors(local)};
    if (below.mirrored != above.mirrored) setWinding(below.mirrored, *group);

    for (const std::size_t child : bonesFirst(_tree.children(index)))
        group->addChild(node(child, below).get());
    if (const auto mesh = place.indexOf("mesh", _document->count("meshes")))
        addMesh(index, *mesh, *group);
    addAttachments(index, *group);
    return group;
}

/// Returns what makes all weights of a node's morph targets positive; nothing if they are.
std::vector<float> SceneReader::weightShifts(std::size_t index, std::size_t mesh)
{
    if (!_meshes.isMorphed(mesh)) return {};
    std::vector<float> lowest = _meshes.weights(mesh, _document->element("nodes", index));
    if (_animations.changesWeights(index))
    {
        const std::vector<float> ofClips = _animations.lowestWeights(index, _meshes.accessors());
        lowest.resize(std::max(lowest.size(), ofClips.size()));
        for (std::size_t i = 0; i < ofClips.size(); ++i)
            lowest[i] = std::min(lowest[i], ofClips[i]);
    }
    bool any = false;
    for (float& value : lowest)
    {
        value = std::max(-value, 0.0f);
        any |= value > 0.0f;
    }
    if (!any) return {};
    _animations.shiftWeights(index, lowest);
    return lowest;
}

void SceneReader::addMesh(std::size_t index, std::size_t mesh, osg::Group& group)
{
    const JsonPlace place = _document->element("nodes", index);
    if (const auto skin = place.indexOf("skin", _document->count("skins")))
    {
        _skinnedMeshes.push_back({index, mesh, *skin});
        return;
    }
    osg::ref_ptr<osg::Geode> geode =
        _meshes.isMorphed(mesh) ? _meshes.own(mesh, place, nullptr, weightShifts(index, mesh))
                                : _meshes.shared(mesh);
    if (_animations.changesWeights(index) && _meshes.isMorphed(mesh))
    {
        const osg::ref_ptr<osgAnimation::UpdateMorph> callback = new osgAnimation::UpdateMorph;
        callback->addTarget(weightsTarget(index));
        geode->setUpdateCallback(callback.get());
    }
    if (const auto instancing = place.extension("EXT_mesh_gpu_instancing"))
        addInstances(*instancing, *geode, group);
    else
        group.addChild(geode.get());
}

/// Adds the mesh once for each place that an instanced node has.
void SceneReader::addInstances(const JsonPlace& instancing, osg::Node& mesh, osg::Group& group)
{
    const JsonPlace attributes = instancing.at("attributes");
    std::optional<std::size_t> count;
    const auto read = [&](const char* name, unsigned int components)
    {
        std::vector<float> values;
        const auto index = attributes.find(name);
        if (!index) return values;
        const Accessor accessor = _meshes.accessors().open(*index, components);
        if (count && *count != accessor.count)
            index->refuse("has " + std::to_string(accessor.count) + " elements for " +
                          std::to_string(*count) + " instances");
        count = accessor.count;
        _document->take(accessor.count * kNodeBytes, accessor.place);
        values.resize(accessor.count * components);
        _meshes.accessors().copyFloats(accessor, values.data());
        return values;
    };
    const std::vector<float> t = read("TRANSLATION", 3), r = read("ROTATION", 4),
                             s = read("SCALE", 3);
    for (std::size_t i = 0; i < count.value_or(0); ++i)
    {
        NodeTransform transform;
        if (!t.empty()) transform.translation.set(t[3 * i], t[3 * i + 1], t[3 * i + 2]);
        if (!r.empty()) transform.rotation.set(r[4 * i], r[4 * i + 1], r[4 * i + 2], r[4 * i + 3]);
        if (!s.empty()) transform.scale.set(s[3 * i], s[3 * i + 1], s[3 * i + 2]);
        const osg::ref_ptr<osg::MatrixTransform> instance =
            new osg::MatrixTransform(transform.toMatrix());
        instance->addChild(&mesh);
        group.addChild(instance.get());
    }
}

void SceneReader::addAttachments(std::size_t index, osg::Group& group)
{
    const JsonPlace place = _document->element("nodes", index);
    if (place.find("camera")) group.addChild(readCamera(*_document, place).get());
    const auto use = place.extension("KHR_lights_punctual");
    if (!use) return;
    const int number = kFirstLight + static_cast<int>(_lights.size());
    _lights.push_back(readLight(*_document, *use, number));
    group.addChild(_lights.back().get());
}

/// Adds the meshes below the skeleton itself, behind the bones, which are updated first.
void SceneReader::addSkinnedMeshes(osg::Group& skeleton)
{
    for (const SkinnedMesh& mesh : _skinnedMeshes)
    {
        const JsonPlace place = _document->element("nodes", mesh.node);
        const Skin& skin = _skins.read(mesh.skin, _bones, _meshes.accessors());
        const osg::ref_ptr<osg::Geode> geode =
            _meshes.own(mesh.mesh, place, &skin, weightShifts(mesh.node, mesh.mesh));
        if (_animations.changesWeights(mesh.node) && _meshes.isMorphed(mesh.mesh))
        {
            const osg::ref_ptr<osgAnimation::UpdateMorph> callback = new osgAnimation::UpdateMorph;
            callback->addTarget(weightsTarget(mesh.node));
            geode->setUpdateCallback(callback.get());
        }
        skeleton.addChild(geode.get());
    }
}

osg::ref_ptr<osg::Node> SceneReader::read()
{
    const osg::ref_ptr<osg::MatrixTransform> top = new osg::MatrixTransform;
    if (_document->options().rotation) top->setMatrix(osg::Matrix::rotate(osg::PI_2, osg::X_AXIS));
    // The rasterizer's normals would grow and fade with the scales of nodes.
    top->getOrCreateStateSet()->setMode(GL_NORMALIZE, osg::StateAttribute::ON);
    if (const auto scene = chosenScene(*_document))
    {
        top->setName(scene->textOr("name", ""));
        setExtras(*scene, *top);
    }
    osg::ref_ptr<osg::Group> parent = top;
    if (_skins.hasBones())
    {
        const osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
        skeleton->setDefaultUpdateCallback();
        top->addChild(skeleton.get());
        parent = skeleton;
    }
    for (const std::size_t root : bonesFirst(_tree.roots(*_document)))
        parent->addChild(node(root, Above()).get());
    addSkinnedMeshes(*parent);
    for (const auto& light : _lights)
        light->setStateSetModes(*top->getOrCreateStateSet(), osg::StateAttribute::ON);
    constexpr std::size_t kShown = kOpenGLLights - kFirstLight;
    if (_lights.size() > kShown)
        _document->note("has " + std::to_string(_lights.size()) +
                        " lights; OpenGL shows the first " + std::to_string(kShown) +
                        " of them, beside the viewer's own, and rays all");
    const auto manager = _animations.read(_meshes.accessors());
    if (manager) top->setUpdateCallback(manager.get());
    if (!_skinnedMeshes.empty()) setRigBounds(*top, manager.get());
    return top;
}

} // namespace osgRayTrace::gltf
