// MeshReader.cpp - puts arrays and surfaces together. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/MeshReader.h"

#include "osgPlugins/gltf/Extras.h"
#include "osgPlugins/gltf/FlatNormals.h"
#include "osgPlugins/gltf/Srgb.h"
#include "osgRayTrace/base/NumberText.h"

#include <osgAnimation/MorphTransformSoftware>

#include <algorithm>

namespace osgRayTrace::gltf
{

namespace
{

constexpr std::uint64_t kPrimitiveBytes = 1024; ///< of a Geometry without its arrays
constexpr unsigned int kTangentAttribute = 6;   ///< OpenGL's fixed function has no use for it

/// Returns the colours of what is not lit: the material's factor times those of the vertices.
osg::ref_ptr<osg::Array> unlitColors(const osg::Array* colors, const osg::Vec4& factor)
{
    if (!colors)
    {
        const osg::ref_ptr<osg::Vec4Array> one = new osg::Vec4Array(osg::Array::BIND_OVERALL);
        one->push_back(displayColor(factor));
        return one;
    }
    const osg::ref_ptr<osg::Vec4Array> product = new osg::Vec4Array(osg::Array::BIND_PER_VERTEX);
    const auto* bytes = dynamic_cast<const osg::Vec4ubArray*>(colors);
    const auto* floats = dynamic_cast<const osg::Vec4Array*>(colors);
    for (unsigned int i = 0; i < colors->getNumElements(); ++i)
    {
        osg::Vec4 color = floats ? (*floats)[i] : osg::Vec4();
        for (int c = 0; bytes && c < 4; ++c)
            color[c] = static_cast<float>((*bytes)[i][c]) / 255.0f;
        for (int c = 0; c < 3; ++c)
            color[c] = linearValue(color[c]) * factor[c];
        color.a() *= factor.a();
        product->push_back(displayColor(color));
    }
    return product;
}

/// Sets arrays, primitives and state. The arrays may be shared with other geometries.
void fill(osg::Geometry& geometry, const Vertices& vertices, const Surface& surface)
{
    const auto perVertex = osg::Array::BIND_PER_VERTEX;
    geometry.setUseDisplayList(false);
    geometry.setUseVertexBufferObjects(true);
    geometry.setVertexArray(vertices.positions.get());
    if (vertices.normals) geometry.setNormalArray(vertices.normals.get(), perVertex);
    if (vertices.tangents)
        geometry.setVertexAttribArray(kTangentAttribute, vertices.tangents.get(), perVertex);
    for (unsigned int set = 0; set < vertices.texcoords.size(); ++set)
        geometry.setTexCoordArray(set, vertices.texcoords[set].get(), perVertex);
    for (const Surface::ExtraUnit& extra : surface.extraUnits)
        if (extra.set < vertices.texcoords.size())
            geometry.setTexCoordArray(extra.unit, vertices.texcoords[extra.set].get(), perVertex);
    const bool factored = !surface.lit && surface.color != osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f);
    if (factored || (!surface.lit && !vertices.colors))
        geometry.setColorArray(unlitColors(vertices.colors.get(), surface.color).get());
    else if (vertices.colors)
        geometry.setColorArray(vertices.colors.get(), perVertex);
    geometry.addPrimitiveSet(vertices.primitives.get());
    geometry.setStateSet(surface.states.get());
}

/// Returns the names of KHR_materials_variants; an empty list if the file has none.
std::vector<std::string> variantNames(const JsonPlace& root)
{
    std::vector<std::string> names;
    const auto list = root.extension("KHR_materials_variants");
    for (std::size_t i = 0; list && i < list->sizeOf("variants"); ++i)
        names.push_back(list->at("variants")[i].textOr("name", ""));
    return names;
}

/// Returns the number of the variant that the options name, or whose number they give; nothing,
/// with a note, if the file does not have it.
std::optional<std::size_t> chosenVariant(const std::vector<std::string>& names, Document& document)
{
    const std::string& wanted = document.options().variant;
    if (wanted.empty()) return std::nullopt;
    const auto named = std::find(names.begin(), names.end(), wanted);
    if (named != names.end()) return static_cast<std::size_t>(named - names.begin());
    const auto number = engine::parseNumber<std::size_t>(wanted);
    if (number && *number < names.size()) return *number;
    document.note("has " + std::to_string(names.size()) + " variants, and none is '" + wanted +
                  "'");
    return std::nullopt;
}

template <typename ArrayType> osg::ref_ptr<ArrayType> clone(const ArrayType& array)
{
    return new ArrayType(array, osg::CopyOp::DEEP_COPY_ARRAYS);
}

float valueOr0(const std::vector<float>& values, std::size_t i)
{
    return i < values.size() ? values[i] : 0.0f;
}

/// Takes a multiple of a target's moves from an array at rest.
template <typename ArrayType>
void subtract(const osg::ref_ptr<osg::Vec3Array>& moves, float factor, ArrayType* rest)
{
    if (!moves || !rest || factor == 0.0f) return;
    for (std::size_t i = 0; i < rest->size(); ++i)
        for (int c = 0; c < 3; ++c)
            (*rest)[i][c] -= factor * (*moves)[i][c];
}

} // namespace

MeshReader::MeshReader(Document& document)
    : _document(&document), _vertices(document), _surfaces(document)
{
    const std::vector<std::string> names = variantNames(document.root());
    _variants = names.size();
    _variant = chosenVariant(names, document);
}

bool MeshReader::isMorphed(std::size_t mesh) const
{
    const JsonPlace primitives = _document->element("meshes", mesh).at("primitives");
    for (std::size_t i = 0; i < primitives.size(); ++i)
        if (primitives[i].sizeOf("targets") > 0) return true;
    return false;
}

/// Returns the primitive's material: that of the chosen variant, if it has one.
std::optional<std::size_t> MeshReader::materialOf(const JsonPlace& primitive) const
{
    const std::size_t count = _document->count("materials");
    const auto own = primitive.indexOf("material", count);
    const auto mapped = primitive.extension("KHR_materials_variants");
    if (!mapped || !_variant) return own;
    const JsonPlace mappings = mapped->at("mappings");
    for (std::size_t i = 0; i < mappings.size(); ++i)
    {
        const JsonPlace ofMapping = mappings[i].at("variants");
        for (std::size_t k = 0; k < ofMapping.size(); ++k)
            if (ofMapping[k].index(_variants) == *_variant)
                return mappings[i].at("material").index(count);
    }
    return own;
}

const std::vector<MeshReader::Primitive>& MeshReader::primitives(std::size_t mesh)
{
    const auto held = _primitives.find(mesh);
    if (held != _primitives.end()) return held->second;
    const JsonPlace places = _document->element("meshes", mesh).at("primitives");
    std::vector<Primitive> result;
    for (std::size_t i = 0; i < places.size(); ++i)
    {
        const JsonPlace place = places[i];
        _document->take(kPrimitiveBytes, place);
        Vertices vertices = _vertices.read(place);
        if (!vertices.primitives) continue;
        const auto material = materialOf(place);
        const bool unlit =
            material && _document->element("materials", *material).extension("KHR_materials_unlit");
        if (!vertices.normals && !unlit && isOfTriangles(*vertices.primitives))
            vertices = withFlatNormals(vertices, *_document, place);
        const SurfaceUse use{vertices.colors != nullptr, vertices.normals != nullptr};
        const Surface& surface = _surfaces.read(material, use);
        if (surface.usesTangents) _vertices.readTargetTangents(place, vertices);
        result.push_back({place, std::move(vertices), &surface});
    }
    return _primitives.emplace(mesh, std::move(result)).first->second;
}

osg::ref_ptr<osg::Geode> MeshReader::emptyGeode(std::size_t mesh) const
{
    const JsonPlace place = _document->element("meshes", mesh);
    const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->setName(place.textOr("name", ""));
    setExtras(place, *geode);
    return geode;
}

osg::ref_ptr<osg::Geode> MeshReader::shared(std::size_t mesh)
{
    osg::ref_ptr<osg::Geode>& held = _shared[mesh];
    if (held) return held;
    const osg::ref_ptr<osg::Geode> geode = emptyGeode(mesh);
    for (const Primitive& primitive : primitives(mesh))
    {
        const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
        geometry->setName(geode->getName());
        fill(*geometry, primitive.vertices, *primitive.surface);
        geode->addDrawable(geometry.get());
    }
    held = geode;
    return held;
}

std::vector<float> MeshReader::weights(std::size_t mesh, const JsonPlace& node) const
{
    const JsonPlace place = _document->element("meshes", mesh);
    const auto list = node.find("weights") ? node.find("weights") : place.find("weights");
    std::vector<float> values;
    for (std::size_t i = 0; list && i < list->size(); ++i)
        values.push_back((*list)[i].number());
    return values;
}

osg::ref_ptr<osgAnimation::MorphGeometry>
MeshReader::morphed(const Primitive& primitive, const std::vector<float>& weights,
                    const std::vector<float>& shifts) const
{
    const Vertices& vertices = primitive.vertices;
    const osg::ref_ptr<osgAnimation::MorphGeometry> morph = new osgAnimation::MorphGeometry;
    fill(*morph, vertices, *primitive.surface);
    // The transform writes into these.
    const bool movesTangents = vertices.tangents && !shifts.empty();
    _document->take(vertices.count() * (movesTangents ? 64u : 48u), primitive.place);
    const osg::ref_ptr<osg::Vec3Array> positions = clone(*vertices.positions);
    morph->setVertexArray(positions.get());
    const osg::ref_ptr<osg::Vec3Array> normalsAtRest =
        vertices.normals ? clone(*vertices.normals) : nullptr;
    if (normalsAtRest) morph->setNormalArray(normalsAtRest.get(), osg::Array::BIND_PER_VERTEX);
    const osg::ref_ptr<osg::Vec4Array> tangents =
        movesTangents ? clone(*vertices.tangents) : nullptr;
    if (tangents)
        morph->setVertexAttribArray(kTangentAttribute, tangents.get(), osg::Array::BIND_PER_VERTEX);
    morph->setMethod(osgAnimation::MorphGeometry::RELATIVE);
    const bool normals =
        vertices.normals && std::all_of(vertices.targets.begin(), vertices.targets.end(),
                                        [](const MorphTarget& t) { return t.normals.valid(); });
    for (std::size_t i = 0; i < vertices.targets.size(); ++i)
    {
        const MorphTarget& target = vertices.targets[i];
        const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
        geometry->setVertexArray(target.positions.get());
        if (target.normals)
            geometry->setNormalArray(target.normals.get(), osg::Array::BIND_PER_VERTEX);
        if (target.tangents)
            geometry->setVertexAttribArray(kTangentAttribute, target.tangents.get(),
                                           osg::Array::BIND_PER_VERTEX);
        const float shift = valueOr0(shifts, i);
        morph->addMorphTarget(geometry.get(), valueOr0(weights, i) + shift);
        subtract(target.positions, shift, positions.get());
        if (normals) subtract(target.normals, shift, normalsAtRest.get());
        subtract(target.tangents, shift, tangents.get());
    }
    morph->setMorphNormals(normals);
    morph->setMorphTransformImplementation(new osgAnimation::MorphTransformSoftware);
    morph->transformSoftwareMethod();
    return morph;
}

osg::ref_ptr<osg::Geode> MeshReader::own(std::size_t mesh, const JsonPlace& node, const Skin* skin,
                                         const std::vector<float>& shifts)
{
    const osg::ref_ptr<osg::Geode> geode = emptyGeode(mesh);
    const std::vector<float> morphWeights = weights(mesh, node);
    for (const Primitive& primitive : primitives(mesh))
    {
        _document->take(kPrimitiveBytes, primitive.place);
        osg::ref_ptr<osg::Geometry> geometry;
        if (primitive.vertices.targets.empty())
        {
            geometry = new osg::Geometry;
            fill(*geometry, primitive.vertices, *primitive.surface);
        }
        else
            geometry = morphed(primitive, morphWeights, shifts);
        geometry->setName(geode->getName());
        if (skin && !skin->bones.empty() && !primitive.vertices.jointSets.empty())
        {
            _document->take(primitive.vertices.count() * 96, primitive.place);
            geometry = riggedGeometry(*geometry, primitive.vertices, *skin, primitive.place);
        }
        geode->addDrawable(geometry.get());
    }
    return geode;
}

} // namespace osgRayTrace::gltf
