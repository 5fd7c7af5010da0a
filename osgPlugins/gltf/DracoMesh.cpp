// DracoMesh.cpp - calls the draco library, within limits. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/DracoMesh.h"

#include "osgPlugins/gltf/DracoBounds.h"

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>

#include <algorithm>
#include <cstring>
#include <limits>

namespace osgRayTrace::gltf
{

namespace
{

/// What a mesh may have, and what it turned out to have.
struct Limits
{
    std::uint64_t faces, points; ///< of the accessors
    bool strip;                  ///< faces is how many there may be, and not how many there are
    std::uint64_t bytes;         ///< of the library's work
};

constexpr std::uint64_t kFaceBytes = 160;    ///< corner table, indices and traversal, from above
constexpr std::uint64_t kSeamFaceBytes = 48; ///< of an attribute with a corner table of its own
constexpr std::uint64_t kPointBytes = 64;
constexpr int kMostAttributes = 32;
constexpr std::uint8_t kMostComponents = 4; ///< of glTF's attributes
constexpr const char* kTooLarge = "would take memory out of proportion to the file";

/// A decoder of the library that stops where a mesh has more than it may have: the library itself
/// takes memory for whatever counts the bytes have.
template <typename Decoder> class Bounded : public Decoder
{
public:
    Bounded(const draco::DecoderBuffer& bytes, const Limits& limits, bool edgebreaker)
        : _bytes(&bytes), _limits(limits), _edgebreaker(edgebreaker)
    {
    }

    const std::string& problem() const { return _problem; }

    /// Is called when an attribute's prediction method has been read, and its values have not.
    const draco::MeshAttributeIndicesEncodingData*
    GetAttributeEncodingData(int attribute) const override
    {
        const auto* order = Decoder::GetAttributeEncodingData(attribute);
        if (!order) return nullptr;
        const auto components = this->point_cloud()->attribute(attribute)->num_components();
        if (dracoOrientationsFit(*_bytes, static_cast<std::uint32_t>(order->num_values),
                                 static_cast<std::uint8_t>(components)))
            return order;
        stop(kTooLarge);
        return nullptr; // so the library does not predict
    }

protected:
    bool DecodeConnectivity() override
    {
        const auto counts = dracoCounts(*_bytes, _edgebreaker);
        if (!counts) return stop("is not of draco's version 2.2, or ends in its header");
        if (_limits.strip ? counts->faces > _limits.faces : counts->faces != _limits.faces)
            return stop("has " + std::to_string(counts->faces) + " triangles, and the indices " +
                        (_limits.strip ? "at most " : "") + std::to_string(_limits.faces));
        // A mesh has no more vertices than corners, and points are split from vertices.
        if (counts->points > 3 * counts->faces || counts->seamAttributes > kMostAttributes ||
            counts->faces * (kFaceBytes + kSeamFaceBytes * counts->seamAttributes) > _limits.bytes)
            return stop(kTooLarge);
        return Decoder::DecodeConnectivity();
    }

    /// Is called when all attributes are described, and none has memory.
    bool DecodeAllAttributes() override
    {
        const draco::PointCloud& cloud = *this->point_cloud();
        if (cloud.num_points() != _limits.points)
            return stop("has " + std::to_string(cloud.num_points()) +
                        " vertices, and the accessors " + std::to_string(_limits.points));
        std::uint64_t bytesOfPoint = kPointBytes;
        for (int i = 0; i < cloud.num_attributes(); ++i)
        {
            const draco::PointAttribute& attribute = *cloud.attribute(i);
            if (attribute.num_components() > kMostComponents || i >= kMostAttributes)
                return stop("has attributes that glTF has no use for");
            bytesOfPoint += std::uint64_t(attribute.byte_stride()) + 8 * kMostComponents;
        }
        if (bytesOfPoint * cloud.num_points() > _limits.bytes) return stop(kTooLarge);
        return Decoder::DecodeAllAttributes();
    }

private:
    bool stop(const std::string& problem) const
    {
        _problem = problem;
        return false;
    }

    const draco::DecoderBuffer* _bytes; ///< as far as they are not read yet
    Limits _limits;
    bool _edgebreaker;
    mutable std::string _problem; ///< empty: none so far
};

template <typename Decoder>
void decode(draco::DecoderBuffer& bytes, bool edgebreaker, const Limits& limits, draco::Mesh& mesh,
            const JsonPlace& place)
{
    Bounded<Decoder> decoder(bytes, limits, edgebreaker);
    const draco::Status status = decoder.Decode(draco::DecoderOptions(), &bytes, &mesh);
    if (!decoder.problem().empty()) place.refuse(decoder.problem());
    if (!status.ok()) place.refuse("is damaged: " + status.error_msg_string());
}

/// Converts the values of all points, in their order.
template <typename T>
bool convert(const draco::PointAttribute& from, std::size_t points, std::string& bytes)
{
    const std::size_t components = from.num_components();
    std::vector<T> values(components);
    for (std::size_t i = 0; i < points; ++i)
    {
        const auto value = from.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(i)));
        if (value.value() >= from.size()) return false;
        if (!from.ConvertValue<T>(value, values.data())) return false;
        std::memcpy(bytes.data() + i * components * sizeof(T), values.data(),
                    components * sizeof(T));
    }
    return true;
}

bool convert(const draco::PointAttribute& from, const Accessor& layout, std::string& bytes)
{
    switch (layout.type)
    {
    case ComponentType::Byte:
        return convert<std::int8_t>(from, layout.count, bytes);
    case ComponentType::UnsignedByte:
        return convert<std::uint8_t>(from, layout.count, bytes);
    case ComponentType::Short:
        return convert<std::int16_t>(from, layout.count, bytes);
    case ComponentType::UnsignedShort:
        return convert<std::uint16_t>(from, layout.count, bytes);
    case ComponentType::UnsignedInt:
        return convert<std::uint32_t>(from, layout.count, bytes);
    case ComponentType::Float:
        return convert<float>(from, layout.count, bytes);
    }
    return false;
}

std::string valuesOf(const draco::Mesh& mesh, const DracoAttribute& wanted, const JsonPlace& place)
{
    const draco::PointAttribute* found = mesh.GetAttributeByUniqueId(wanted.id);
    const std::string name = "attribute " + std::to_string(wanted.id);
    if (!found) place.refuse("has no " + name);
    if (found->num_components() != wanted.layout.components)
        place.refuse("has " + std::to_string(found->num_components()) + " components of " + name +
                     ", and " + wanted.layout.place.path() + " " +
                     std::to_string(wanted.layout.components));
    std::string bytes(wanted.layout.count * wanted.layout.elementSize(), '\0');
    if (!convert(*found, wanted.layout, bytes))
        place.refuse("has values of " + name + " that do not fit " + wanted.layout.place.path());
    return bytes;
}

template <typename T> std::string indicesOf(const draco::Mesh& mesh, const JsonPlace& place)
{
    std::string bytes(std::size_t(mesh.num_faces()) * 3 * sizeof(T), '\0');
    char* to = bytes.data();
    for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face)
        for (const draco::PointIndex& point : mesh.face(face))
        {
            if (point.value() > std::numeric_limits<T>::max() || point.value() >= mesh.num_points())
                place.refuse("has the index " + std::to_string(point.value()) +
                             ", which does not fit the accessor of the indices");
            const T index = static_cast<T>(point.value());
            std::memcpy(to, &index, sizeof(T));
            to += sizeof(T);
        }
    return bytes;
}

std::string indicesOf(const draco::Mesh& mesh, const Accessor& layout, const JsonPlace& place)
{
    if (layout.type == ComponentType::UnsignedByte) return indicesOf<std::uint8_t>(mesh, place);
    if (layout.type == ComponentType::UnsignedShort) return indicesOf<std::uint16_t>(mesh, place);
    if (layout.type == ComponentType::UnsignedInt) return indicesOf<std::uint32_t>(mesh, place);
    layout.place.refuse("has indices that are no unsigned integers");
}

} // namespace

bool readsDraco()
{
    return true;
}

DracoMesh decodeDraco(const std::string& compressed, const Accessor& indices, bool strip,
                      const std::vector<DracoAttribute>& attributes, std::uint64_t mostBytes,
                      const JsonPlace& place)
{
    draco::DecoderBuffer bytes;
    bytes.Init(compressed.data(), compressed.size());
    draco::DecoderBuffer again = bytes; // the decoders read the header themselves
    draco::DracoHeader header;
    const draco::Status status = draco::PointCloudDecoder::DecodeHeader(&bytes, &header);
    if (!status.ok()) place.refuse("is damaged: " + status.error_msg_string());
    if (header.encoder_type != draco::TRIANGULAR_MESH) place.refuse("is no mesh of triangles");
    if (header.encoder_method > draco::MESH_EDGEBREAKER_ENCODING)
        place.refuse("is encoded by a method that is not known");
    if ((header.flags & METADATA_FLAG_MASK) != 0 && !isSmallDracoMetadata(bytes))
        place.refuse("has metadata that are damaged, or more than a mesh has use for");
    const std::size_t points = attributes.empty() ? 0 : attributes.front().layout.count;
    const std::size_t faces =
        strip ? indices.count - std::min<std::size_t>(indices.count, 2) : indices.count / 3;
    const Limits limits{faces, points, strip, mostBytes};
    draco::Mesh mesh;
    if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING)
        decode<draco::MeshEdgebreakerDecoder>(again, true, limits, mesh, place);
    else
        decode<draco::MeshSequentialDecoder>(again, false, limits, mesh, place);
    // The library may leave out triangles without an area, and then has other counts.
    if ((!strip && mesh.num_faces() != limits.faces) || mesh.num_points() != limits.points)
        place.refuse("has other triangles than it says");
    DracoMesh result;
    result.indices = indicesOf(mesh, indices, place);
    for (const DracoAttribute& attribute : attributes)
        result.attributes.push_back(valuesOf(mesh, attribute, place));
    return result;
}

} // namespace osgRayTrace::gltf
