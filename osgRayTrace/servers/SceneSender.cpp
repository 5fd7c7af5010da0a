// SceneSender.cpp - messages with what a receiver does not have of a scene yet. Layer: servers.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/servers/SceneWire.h"

#include <utility>

namespace osgRayTrace::engine
{

namespace
{

/// Writes all members of a part. A writer reads them alone, but shares its functions with readers.
template <class Part> void putFields(WireWriter& out, const Part& part)
{
    fieldsOf(out, const_cast<Part&>(part));
}

void putTexture(WireWriter& out, const Texture& texture)
{
    putFields(out, texture);
    out(static_cast<uint32_t>(texture.mips.size()));
    for (const Texture& mip : texture.mips)
        putFields(out, mip);
}

void putMaterial(WireWriter& out, const Material& material)
{
    putFields(out, material);
    out(material.detail != nullptr);
    if (material.detail) putFields(out, *material.detail);
}

} // namespace

/// The parts of the message at work.
struct SceneSender::MessageParts
{
    Bytes bytes;
    WireWriter out{bytes};
};

/// Returns the number of a part, and writes the part with put(number) if the receiver lacks it.
template <class Part, class Put>
uint32_t SceneSender::numberOf(const std::shared_ptr<const Part>& part, KnownParts<Part>& known,
                               const Put& put)
{
    Known<Part>& entry = known[part.get()];
    entry.message = _messages;
    // The address of a part that is gone may be that of another one now.
    if (entry.number != 0 && entry.part.lock() == part) return entry.number;
    entry.part = part;
    entry.number = ++_numbers;
    const uint32_t number = entry.number; // putting a mesh may move the entries
    put(number);
    return number;
}

template <class T>
uint32_t SceneSender::arrayNumber(const SharedArray<T>& array,
                                  const std::shared_ptr<const Mesh>& holder, MessageParts& parts)
{
    if (array.empty()) return 0;
    KnownArray& entry = _arrays[array.data()];
    const std::size_t bytes = array.size() * sizeof(T);
    const uint64_t hash = memoryHash(array.data(), bytes);
    const bool known =
        entry.number != 0 && entry.bytes == bytes && entry.hash == hash && !entry.holder.expired();
    entry.holder = holder;
    entry.hash = hash;
    if (known) return entry.number;
    entry.bytes = bytes;
    entry.number = ++_numbers;
    parts.out(kArrayKind<T>, entry.number);
    parts.out.array(array.data(), array.size());
    return entry.number;
}

uint32_t SceneSender::meshNumber(const std::shared_ptr<const Mesh>& mesh, MessageParts& parts)
{
    const auto put = [&](uint32_t number)
    {
        Bytes arrays;
        WireWriter numbers(arrays);
        forEachArray(*mesh, [&](const auto& array) { numbers(arrayNumber(array, mesh, parts)); });
        parts.out(PartKind::Mesh, number, mesh->deforms, mesh->changed,
                  static_cast<uint32_t>(mesh->moreUvs.size()));
        parts.out.append(arrays.data(), arrays.size());
    };
    return numberOf(mesh, _meshes, put);
}

Bytes SceneSender::message(const Scene& scene)
{
    ++_messages;
    MessageParts parts;
    std::vector<uint32_t> meshes, textures;
    meshes.reserve(scene.meshes.size());
    for (const auto& mesh : scene.meshes)
        meshes.push_back(meshNumber(mesh, parts));
    for (const auto& texture : scene.textures)
        textures.push_back(numberOf(texture, _textures,
                                    [&](uint32_t number)
                                    {
                                        parts.out(PartKind::Texture, number);
                                        putTexture(parts.out, *texture);
                                    }));
    std::vector<uint32_t> images;
    for (const Light& light : scene.lights)
    {
        const std::shared_ptr<const EnvironmentImage>& image = light.environment.image;
        images.push_back(!image ? 0
                                : numberOf(image, _images,
                                           [&](uint32_t number)
                                           {
                                               parts.out(PartKind::EnvironmentImage, number);
                                               putFields(parts.out, *image);
                                           }));
    }

    std::vector<uint32_t> voxels;
    for (const Volume& volume : scene.volumes)
        voxels.push_back(numberOf(volume.image, _voxels,
                                  [&](uint32_t number)
                                  {
                                      parts.out(PartKind::VolumeImage, number);
                                      putFields(parts.out, *volume.image);
                                  }));

    const auto putSlot = [](WireWriter& out, uint32_t number) { out(number); };
    WireWriter& out = parts.out;
    out(PartKind::None);
    putFields(out, scene);
    putList(out, meshes, _meshSlots, putSlot);
    putList(out, textures, _textureSlots, putSlot);
    putList(out, scene.instances, _instances,
            [](WireWriter& to, const Instance& instance) { putFields(to, instance); });
    putList(out, scene.materials, _materials, putMaterial);
    putList(out, scene.lights, _lights,
            [&](WireWriter& to, const Light& light)
            {
                putFields(to, light);
                to(images[static_cast<std::size_t>(&light - scene.lights.data())]);
            });
    putList(out, scene.volumes, _volumes,
            [&](WireWriter& to, const Volume& volume)
            {
                putFields(to, volume);
                to(voxels[static_cast<std::size_t>(&volume - scene.volumes.data())]);
            });
    forgetUnused();
    return std::move(parts.bytes);
}

/// Forgets the parts that the last message does not name, as the receiver does.
void SceneSender::forgetUnused()
{
    const auto forget = [this](auto& known)
    {
        for (auto entry = known.begin(); entry != known.end();)
            entry = entry->second.message == _messages ? std::next(entry) : known.erase(entry);
    };
    forget(_meshes);
    forget(_textures);
    forget(_images);
    forget(_voxels);
    for (auto entry = _arrays.begin(); entry != _arrays.end();)
    {
        const std::shared_ptr<const Mesh> holder = entry->second.holder.lock();
        const bool used = holder && _meshes.count(holder.get()) > 0;
        entry = used ? std::next(entry) : _arrays.erase(entry);
    }
}

} // namespace osgRayTrace::engine
