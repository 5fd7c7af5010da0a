// SceneReceiver.cpp - scenes from messages that nobody need trust. Layer: servers.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/servers/SceneWire.h"

#include "osgRayTrace/servers/SceneFault.h"

#include <unordered_set>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

template <class T> bool takeArray(WireReader& in, MeshArray& array)
{
    // Embree reads past the last position: the vector has room for one more.
    uint64_t count = 0;
    in(count);
    if (!in.good() || count > in.left() / sizeof(T)) return false;
    std::vector<T> values;
    values.reserve(static_cast<std::size_t>(count) + 1);
    values.resize(static_cast<std::size_t>(count));
    if (!in.copy(values.data(), values.size() * sizeof(T))) return false;
    array = SharedArray<T>(std::move(values));
    return true;
}

bool takeArray(WireReader& in, PartKind kind, MeshArray& array)
{
    switch (kind)
    {
    case PartKind::Floats:
        return takeArray<float>(in, array);
    case PartKind::Vec2s:
        return takeArray<Vec2>(in, array);
    case PartKind::Vec3s:
        return takeArray<Vec3>(in, array);
    case PartKind::Vec4s:
        return takeArray<Vec4>(in, array);
    case PartKind::Triangles:
        return takeArray<UVec3>(in, array);
    case PartKind::None:
    case PartKind::Mesh:
    case PartKind::Texture:
    case PartKind::EnvironmentImage:
    case PartKind::VolumeImage:
        break;
    }
    return false;
}

bool takeTexture(WireReader& in, Texture& texture)
{
    constexpr uint32_t kMostMips = 32;
    fieldsOf(in, texture);
    uint32_t mips = 0;
    in(mips);
    if (!in.good() || mips > kMostMips) return false;
    for (uint32_t i = 0; i < mips && in.good(); ++i)
    {
        texture.mips.emplace_back();
        fieldsOf(in, texture.mips.back());
    }
    return in.good();
}

void takeMaterial(WireReader& in, Material& material)
{
    material = Material();
    fieldsOf(in, material);
    bool hasDetail = false;
    in(hasDetail);
    if (!in.good() || !hasDetail) return;
    auto detail = std::make_shared<MaterialDetail>();
    fieldsOf(in, *detail);
    material.detail = std::move(detail);
}

} // namespace

bool SceneReceiver::refuse(const char* fault)
{
    _fault = fault;
    return false;
}

/// Reads a part: its number, and what it is made of. Returns false after the last one, too.
bool SceneReceiver::takePart(WireReader& in)
{
    PartKind kind = PartKind::None;
    in(kind);
    if (!in.good()) return refuse("a message about a scene is damaged");
    if (kind == PartKind::None) return false;
    uint32_t number = 0;
    in(number);
    const bool isNew = number != 0 && !_arrays.count(number) && !_meshes.count(number) &&
                       !_textures.count(number) && !_images.count(number) && !_voxels.count(number);
    if (!isNew) return refuse("a message about a scene has a part twice");
    if (kind == PartKind::Mesh)
    {
        auto mesh = std::make_shared<Mesh>();
        uint32_t moreUvs = 0;
        in(mesh->deforms, mesh->changed, moreUvs);
        if (!in.good() || moreUvs > kUvSets - kFirstMoreUvs)
            return refuse("a message about a scene has a mesh of too many texture coordinates");
        mesh->moreUvs.resize(moreUvs);
        std::array<uint32_t, kMostMeshArrays> numbers{};
        bool found = in.copy(numbers.data(), (kMeshArrays + moreUvs) * sizeof numbers[0]);
        const uint32_t* next = numbers.data();
        forEachArray(*mesh,
                     [&](auto& array)
                     {
                         using Array = std::remove_reference_t<decltype(array)>;
                         const uint32_t wanted = *next++;
                         if (wanted == 0) return;
                         const auto known = _arrays.find(wanted);
                         const Array* values =
                             known == _arrays.end() ? nullptr : std::get_if<Array>(&known->second);
                         found = found && values;
                         if (values) array = *values;
                     });
        if (!found) return refuse("a message about a scene lacks an array of a mesh");
        if (const char* fault = meshFault(*mesh)) return refuse(fault);
        _meshes[number] = std::move(mesh);
        _meshArrays[number] = numbers;
    }
    else if (kind == PartKind::Texture)
    {
        auto texture = std::make_shared<Texture>();
        if (!takeTexture(in, *texture)) return refuse("a message about a texture is damaged");
        if (const char* fault = textureFault(*texture)) return refuse(fault);
        _textures[number] = std::move(texture);
    }
    else if (kind == PartKind::EnvironmentImage)
    {
        auto image = std::make_shared<EnvironmentImage>();
        fieldsOf(in, *image);
        if (!in.good()) return refuse("a message about an environment is damaged");
        if (const char* fault = environmentFault(*image)) return refuse(fault);
        _images[number] = std::move(image);
    }
    else if (kind == PartKind::VolumeImage)
    {
        auto image = std::make_shared<VolumeImage>();
        fieldsOf(in, *image);
        if (!in.good()) return refuse("a message about a volume is damaged");
        if (const char* fault = volumeFault(*image)) return refuse(fault);
        _voxels[number] = std::move(image);
    }
    else if (!takeArray(in, kind, _arrays[number]))
        return refuse("a message about an array is damaged");
    return true;
}

bool SceneReceiver::takeLists(WireReader& in, Scene& scene)
{
    const bool complete =
        takeList(in, scene.instances,
                 [&](WireReader& from, std::size_t i) { fieldsOf(from, scene.instances[i]); }) &&
        takeList(in, scene.materials,
                 [&](WireReader& from, std::size_t i)
                 { takeMaterial(from, scene.materials[i]); }) &&
        takeList(in, scene.lights,
                 [&](WireReader& from, std::size_t i)
                 {
                     Light& light = scene.lights[i];
                     uint32_t image = 0;
                     fieldsOf(from, light);
                     from(image);
                     const auto known = _images.find(image);
                     light.environment.image = known == _images.end() ? nullptr : known->second;
                     if (image != 0 && known == _images.end()) from.fail();
                 }) &&
        takeList(in, scene.volumes,
                 [&](WireReader& from, std::size_t i)
                 {
                     uint32_t image = 0;
                     fieldsOf(from, scene.volumes[i]);
                     from(image);
                     const auto known = _voxels.find(image);
                     if (known == _voxels.end())
                         from.fail();
                     else
                         scene.volumes[i].image = known->second;
                 });
    if (!complete || in.left() > 0) return refuse("a message about a scene is damaged");
    return true;
}

/// Reads which mesh and which texture each index of the scene names.
bool SceneReceiver::takeSlots(WireReader& in, Scene& scene)
{
    const auto takeNumbers = [&](std::vector<uint32_t>& numbers)
    { return takeList(in, numbers, [&](WireReader& from, std::size_t i) { from(numbers[i]); }); };
    if (!takeNumbers(_meshSlots) || !takeNumbers(_textureSlots))
        return refuse("a message about a scene is damaged");
    const auto fill = [](const std::vector<uint32_t>& numbers, const auto& known, auto& parts)
    {
        parts.clear();
        for (const uint32_t number : numbers)
        {
            const auto part = known.find(number);
            if (part == known.end()) return false;
            parts.push_back(part->second);
        }
        return true;
    };
    if (!fill(_meshSlots, _meshes, scene.meshes) || !fill(_textureSlots, _textures, scene.textures))
        return refuse("a message about a scene lacks a mesh or a texture");
    return true;
}

std::shared_ptr<const Scene> SceneReceiver::take(const uint8_t* data, std::size_t size)
{
    if (!_fault.empty()) return nullptr;
    WireReader in(data, size);
    while (takePart(in))
        ;
    if (!_fault.empty()) return nullptr;
    auto scene = _scene ? std::make_shared<Scene>(*_scene) : std::make_shared<Scene>();
    fieldsOf(in, *scene);
    if (!in.good())
    {
        refuse("a message about a scene is damaged");
        return nullptr;
    }
    if (!takeSlots(in, *scene) || !takeLists(in, *scene)) return nullptr;
    if (const char* fault = sceneFault(*scene))
    {
        refuse(fault);
        return nullptr;
    }
    forgetUnused(*scene);
    _scene = scene;
    return scene;
}

/// Forgets what the scene does not have, as the sender does.
void SceneReceiver::forgetUnused(const Scene& scene)
{
    const auto keepOnly = [](auto& known, const std::unordered_set<uint32_t>& used)
    {
        for (auto entry = known.begin(); entry != known.end();)
            entry = used.count(entry->first) ? std::next(entry) : known.erase(entry);
    };
    const std::unordered_set<uint32_t> meshes(_meshSlots.begin(), _meshSlots.end());
    keepOnly(_meshes, meshes);
    keepOnly(_meshArrays, meshes);
    std::unordered_set<uint32_t> arrays;
    for (const auto& [mesh, numbers] : _meshArrays)
        arrays.insert(numbers.begin(), numbers.end());
    keepOnly(_arrays, arrays);
    keepOnly(_textures, {_textureSlots.begin(), _textureSlots.end()});
    std::unordered_set<const EnvironmentImage*> shining;
    for (const Light& light : scene.lights)
        shining.insert(light.environment.image.get());
    for (auto image = _images.begin(); image != _images.end();)
        image = shining.count(image->second.get()) ? std::next(image) : _images.erase(image);
    std::unordered_set<const VolumeImage*> filling;
    for (const Volume& volume : scene.volumes)
        filling.insert(volume.image.get());
    for (auto image = _voxels.begin(); image != _voxels.end();)
        image = filling.count(image->second.get()) ? std::next(image) : _voxels.erase(image);
}

} // namespace osgRayTrace::engine
