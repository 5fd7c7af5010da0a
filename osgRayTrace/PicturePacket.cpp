// PicturePacket.cpp - a head of view and settings, and the message of a scene. Layer: public API,
// private.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/PicturePacket.h"

#include "osgRayTrace/servers/BuildIdentity.h"
#include "osgRayTrace/servers/SceneWire.h"

#include <cstdint>
#include <iterator>

namespace osgRayTrace
{

namespace
{

constexpr uint64_t kMagic = 0x7275746369507452; // "RtPictur"
constexpr uint32_t kOptions = static_cast<uint32_t>(std::size(kPictureOptions));

UnpackedPicture refused(const std::string& problem)
{
    UnpackedPicture picture;
    picture.problem = problem;
    return picture;
}

} // namespace

std::vector<unsigned char> packedPicture(const PictureInputs& picture)
{
    engine::Bytes head;
    engine::WireWriter out(head);
    out(kMagic);
    out.text(engine::buildIdentity());
    out.append(picture.view.ptr(), 16 * sizeof(double));
    out.append(picture.projection.ptr(), 16 * sizeof(double));
    out(int32_t(picture.width), int32_t(picture.height));
    for (const char* option : kPictureOptions)
    {
        out.text(option);
        out.text(picture.settings.get(option));
    }
    const engine::Bytes scene = engine::SceneSender().message(picture.scene);
    std::vector<unsigned char> bytes;
    bytes.reserve(head.size() + scene.size());
    bytes.insert(bytes.end(), head.begin(), head.end());
    bytes.insert(bytes.end(), scene.begin(), scene.end());
    return bytes;
}

UnpackedPicture unpackedPicture(const unsigned char* bytes, std::size_t size)
{
    const char* const damaged = "the bytes are not those of a picture, or damaged";
    engine::WireReader in(bytes, size);
    uint64_t magic = 0;
    std::string identity;
    in(magic);
    if (magic != kMagic) return refused(damaged);
    in.text(identity);
    if (!in.good()) return refused(damaged);
    const std::string own = engine::buildIdentity();
    if (identity != own)
        return refused("the scene comes from " + identity + ", and this process is " + own);

    UnpackedPicture picture;
    in.copy(picture.view.ptr(), 16 * sizeof(double));
    in.copy(picture.projection.ptr(), 16 * sizeof(double));
    int32_t width = 0, height = 0;
    in(width, height);
    picture.width = width;
    picture.height = height;
    for (uint32_t i = 0; i < kOptions && in.good(); ++i)
    {
        auto& [name, value] = picture.settings.emplace_back();
        in.text(name);
        in.text(value);
        if (name != kPictureOptions[i]) in.fail();
    }
    if (!in.good()) return refused(damaged);
    engine::SceneReceiver receiver;
    picture.scene = receiver.take(bytes + (size - in.left()), in.left());
    if (!picture.scene) return refused(receiver.fault());
    return picture;
}

} // namespace osgRayTrace
