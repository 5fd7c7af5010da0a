// SceneWire.h - a Scene and its changes as messages, for processes that have no graph. Layer:
// servers.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Scene.h"
#include "osgRayTrace/servers/SceneParts.h"
#include "osgRayTrace/servers/Wire.h"

#include <array>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

namespace osgRayTrace::engine
{

/// The number of arrays that all meshes have.
constexpr std::size_t kMeshArrays = 9;

/// How many a mesh has at most, with the texture coordinates that few have.
constexpr std::size_t kMostMeshArrays = kMeshArrays + kUvSets - kFirstMoreUvs;

/// Makes the messages of one receiver. Parts of a scene that the receiver has are named by number;
/// meshes are told apart by their address while they live, and lists in blocks by their contents.
/// A sender keeps no part alive.
class SceneSender
{
public:
    /// Returns the message that turns what the receiver has into this scene.
    Bytes message(const Scene& scene);

private:
    template <class Part> struct Known
    {
        std::weak_ptr<const Part> part;
        uint32_t number = 0;
        uint64_t message = 0; ///< the last message that names the part
    };
    template <class Part> using KnownParts = std::unordered_map<const Part*, Known<Part>>;
    struct KnownArray
    {
        std::weak_ptr<const Mesh> holder; ///< while it lives, the address names the array
        std::size_t bytes = 0;
        uint64_t hash = 0; ///< of its contents, which the host may have edited in place
        uint32_t number = 0;
    };
    struct MessageParts;

    template <class Part, class Put>
    uint32_t numberOf(const std::shared_ptr<const Part>& part, KnownParts<Part>& known,
                      const Put& put);
    template <class T>
    uint32_t arrayNumber(const SharedArray<T>& array, const std::shared_ptr<const Mesh>& holder,
                         MessageParts& parts);
    uint32_t meshNumber(const std::shared_ptr<const Mesh>& mesh, MessageParts& parts);
    void forgetUnused();

    uint64_t _messages = 0;
    uint32_t _numbers = 0;
    KnownParts<Mesh> _meshes;
    KnownParts<Texture> _textures;
    KnownParts<EnvironmentImage> _images;
    KnownParts<VolumeImage> _voxels;
    std::unordered_map<const void*, KnownArray> _arrays;
    BlockHashes _meshSlots, _textureSlots, _instances, _materials, _lights, _volumes;
};

/// Takes the messages of one sender. Nothing of a message is trusted.
class SceneReceiver
{
public:
    /// Returns the scene that the message makes of the last one. Null if the message is damaged,
    /// or names what is not there: fault() then says what, and the receiver is of no more use.
    /// Throws std::bad_alloc.
    std::shared_ptr<const Scene> take(const uint8_t* data, std::size_t size);
    std::shared_ptr<const Scene> take(const Bytes& bytes)
    {
        return take(bytes.data(), bytes.size());
    }

    const std::string& fault() const { return _fault; }

private:
    bool takePart(WireReader& in);
    bool takeLists(WireReader& in, Scene& scene);
    bool takeSlots(WireReader& in, Scene& scene);
    bool refuse(const char* fault);
    void forgetUnused(const Scene& scene);

    std::string _fault;
    std::unordered_map<uint32_t, MeshArray> _arrays;
    std::unordered_map<uint32_t, std::shared_ptr<const Mesh>> _meshes;
    std::unordered_map<uint32_t, std::array<uint32_t, kMostMeshArrays>> _meshArrays; ///< by mesh
    std::unordered_map<uint32_t, std::shared_ptr<const Texture>> _textures;
    std::unordered_map<uint32_t, std::shared_ptr<const EnvironmentImage>> _images;
    std::unordered_map<uint32_t, std::shared_ptr<const VolumeImage>> _voxels;
    std::vector<uint32_t> _meshSlots, _textureSlots;
    std::shared_ptr<const Scene> _scene; ///< the last one
};

} // namespace osgRayTrace::engine
