// GraphFingerprint.cpp - a cheap check whether a scene graph has changed. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/GraphFingerprint.h"

#include "osgRayTrace/bridge/GraphCollector.h"
#include "osgRayTrace/bridge/SoftwareVertices.h"

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/PhysicalMaterial>

#include <osg/AlphaFunc>
#include <osg/Billboard>
#include <osg/BlendFunc>
#include <osg/ClipNode>
#include <osg/ClipPlane>
#include <osg/CullFace>
#include <osg/FrontFace>
#include <osg/Geometry>
#include <osg/Light>
#include <osg/LightModel>
#include <osg/LightSource>
#include <osg/Material>
#include <osg/NodeVisitor>
#include <osg/PolygonMode>
#include <osg/PolygonOffset>
#include <osg/PrimitiveRestartIndex>
#include <osg/Program>
#include <osg/TexEnv>
#include <osg/TexGen>
#include <osg/TexGenNode>
#include <osg/TexMat>
#include <osg/Texture>
#include <osg/Transform>

#include <cstring>
#include <optional>
#include <type_traits>
#include <vector>

namespace osgRayTrace::engine
{

namespace
{

/// Mixes values one after the other into 64 bits.
class Digest
{
public:
    uint64_t value() const { return _value; }

    template <class T> void add(const T& item)
    {
        if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T> || std::is_pointer_v<T>)
        {
            uint64_t bits = 0;
            static_assert(sizeof(item) <= sizeof(bits));
            std::memcpy(&bits, &item, sizeof(item));
            addBits(bits);
        }
        else
        {
            for (unsigned int i = 0; i < T::num_components; ++i)
                add(item[i]);
        }
    }

    template <class First, class... Rest> void add(const First& first, const Rest&... rest)
    {
        add(first);
        (add(rest), ...);
    }

    void addMatrix(const osg::Matrixd& matrix)
    {
        for (int i = 0; i < 16; ++i)
            add(matrix.ptr()[i]);
    }

private:
    void addBits(uint64_t bits) // [Steele14, mix64 of SplitMix, chained]
    {
        uint64_t z = (_value ^ bits) + 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        _value = z ^ (z >> 31);
    }

    uint64_t _value = 0;
};

void addMaterial(Digest& digest, const osg::Material& material)
{
    digest.add(material.getColorMode());
    for (const auto face : {osg::Material::FRONT, osg::Material::BACK})
        digest.add(material.getAmbient(face), material.getDiffuse(face), material.getSpecular(face),
                   material.getEmission(face), material.getShininess(face));
}

void addLight(Digest& digest, const osg::Light& light)
{
    digest.add(light.getLightNum(), light.getAmbient(), light.getDiffuse(), light.getSpecular(),
               light.getPosition(), light.getDirection(), light.getConstantAttenuation(),
               light.getLinearAttenuation(), light.getQuadraticAttenuation(),
               light.getSpotExponent(), light.getSpotCutoff());
}

void addTexture(Digest& digest, const osg::Texture& texture)
{
    digest.add(texture.getWrap(osg::Texture::WRAP_S), texture.getWrap(osg::Texture::WRAP_T),
               texture.getFilter(osg::Texture::MAG_FILTER), texture.getInternalFormat());
    for (int c = 0; c < 4; ++c)
        digest.add(texture.getBorderColor()[c]);
    for (unsigned int i = 0; i < texture.getNumImages(); ++i)
    {
        const osg::Image* image = texture.getImage(i);
        digest.add(image, image ? image->getModifiedCount() : 0u);
    }
}

void addTexGen(Digest& digest, const osg::TexGen& texGen)
{
    digest.add(texGen.getMode());
    for (const auto coordinate :
         {osg::TexGen::S, osg::TexGen::T, osg::TexGen::R, osg::TexGen::Q})
        for (int k = 0; k < 4; ++k)
            digest.add(texGen.getPlane(coordinate)[k]);
}

void addPhysicalMaterial(Digest& digest, const PhysicalMaterial& material)
{
    digest.add(material.getBaseColor(), material.getMetallic(), material.getRoughness(),
               material.getTransmission(), material.getIor(), material.getEmission());
    for (const osg::Texture2D* texture :
         {material.getBaseColorTexture(), material.getMetallicRoughnessTexture(),
          material.getTransmissionTexture(), material.getEmissionTexture()})
    {
        digest.add(texture);
        if (texture) addTexture(digest, *texture);
    }
}

/// Of the frame, not of the scene; osgViewer has its own in each frame.
bool isOfTheFrame(const osg::StateAttribute& attribute)
{
    return attribute.getType() == osg::StateAttribute::VIEWPORT ||
           attribute.getType() == osg::StateAttribute::COLORMASK;
}

void addAttribute(Digest& digest, const osg::StateAttribute& attribute)
{
    if (isOfTheFrame(attribute)) return;
    digest.add(&attribute);
    if (const auto* material = dynamic_cast<const osg::Material*>(&attribute))
        addMaterial(digest, *material);
    else if (const osg::Texture* texture = attribute.asTexture())
        addTexture(digest, *texture);
    else if (const auto* physical = dynamic_cast<const PhysicalMaterial*>(&attribute))
        addPhysicalMaterial(digest, *physical);
    else if (const auto* light = dynamic_cast<const osg::Light*>(&attribute))
        addLight(digest, *light);
    else if (const auto* model = dynamic_cast<const osg::LightModel*>(&attribute))
        digest.add(model->getAmbientIntensity(), model->getTwoSided(), model->getLocalViewer(),
                   model->getColorControl());
    else if (const auto* environment = dynamic_cast<const osg::TexEnv*>(&attribute))
        digest.add(environment->getMode(), environment->getColor());
    else if (const auto* textureMatrix = dynamic_cast<const osg::TexMat*>(&attribute))
        digest.addMatrix(textureMatrix->getMatrix());
    else if (const auto* alpha = dynamic_cast<const osg::AlphaFunc*>(&attribute))
        digest.add(alpha->getFunction(), alpha->getReferenceValue());
    else if (const auto* blend = dynamic_cast<const osg::BlendFunc*>(&attribute))
        digest.add(blend->getSource(), blend->getDestination());
    else if (const auto* cull = dynamic_cast<const osg::CullFace*>(&attribute))
        digest.add(cull->getMode());
    else if (const auto* polygons = dynamic_cast<const osg::PolygonMode*>(&attribute))
        digest.add(polygons->getMode(osg::PolygonMode::FRONT));
    else if (const auto* program = dynamic_cast<const osg::Program*>(&attribute))
        digest.add(program->getNumShaders());
    else if (const auto* texGen = dynamic_cast<const osg::TexGen*>(&attribute))
        addTexGen(digest, *texGen);
    else if (const auto* offset = dynamic_cast<const osg::PolygonOffset*>(&attribute))
        digest.add(offset->getFactor(), offset->getUnits());
    else if (const auto* restart = dynamic_cast<const osg::PrimitiveRestartIndex*>(&attribute))
        digest.add(restart->getRestartIndex());
    else if (const auto* plane = dynamic_cast<const osg::ClipPlane*>(&attribute))
        digest.add(plane->getClipPlaneNum(), plane->getClipPlane());
    else if (const auto* front = dynamic_cast<const osg::FrontFace*>(&attribute))
        digest.add(front->getMode());
}

void addAttributes(Digest& digest, const osg::StateSet::AttributeList& attributes)
{
    for (const auto& item : attributes)
    {
        if (!isOfTheFrame(*item.second.first)) digest.add(item.second.second);
        addAttribute(digest, *item.second.first);
    }
}

void addModes(Digest& digest, const osg::StateSet::ModeList& modes)
{
    for (const auto& [mode, value] : modes)
        digest.add(mode, value);
}

void addStateSet(Digest& digest, const osg::StateSet& stateSet)
{
    addModes(digest, stateSet.getModeList());
    addAttributes(digest, stateSet.getAttributeList());
    for (const auto& modes : stateSet.getTextureModeList())
        addModes(digest, modes);
    for (const auto& attributes : stateSet.getTextureAttributeList())
        addAttributes(digest, attributes);
}

/// Follows the children that are active for the eye, as the conversion does.
class FingerprintVisitor : public osg::NodeVisitor
{
public:
    explicit FingerprintVisitor(const ViewingConditions& conditions)
        : osg::NodeVisitor(NODE_VISITOR, TRAVERSE_ACTIVE_CHILDREN),
          _eye(conditions.eye),
          _view(conditions.view),
          _cullStack(conditions.view)
    {
        setTraversalMask(conditions.traversalMask);
        for (const osg::ref_ptr<const osg::StateSet>& stateSet : conditions.inheritedState)
            addStateSet(_digest, *stateSet);
    }

    uint64_t value() const { return _digest.value(); }

    void apply(osg::Node& node) override
    {
        if (const auto* light = dynamic_cast<const AreaLight*>(&node))
            _digest.add(light->getCorner(), light->getEdgeU(), light->getEdgeV(),
                        light->getRadiance(), light->getTwoSided());
        enter(node);
    }

    void apply(osg::Group& node) override { enter(node); }

    void apply(osg::LightSource& node) override
    {
        _digest.add(node.getReferenceFrame());
        if (node.getLight()) addLight(_digest, *node.getLight());
        enter(node);
    }

    void apply(osg::TexGenNode& node) override
    {
        _digest.add(node.getReferenceFrame(), node.getTextureUnit());
        if (node.getTexGen()) addTexGen(_digest, *node.getTexGen());
        enter(node);
    }

    void apply(osg::Transform& node) override
    {
        const osg::Matrixd outer = _sceneFromLocal;
        _sceneFromLocal = worldFromLocal(node, outer, *this, _view);
        _digest.addMatrix(_sceneFromLocal);
        enter(node);
        _sceneFromLocal = outer;
    }

    void apply(osg::Billboard& node) override
    {
        digestView();
        _digest.add(node.getMode(), node.getAxis(), node.getNormal());
        enter(node);
    }

    void apply(osg::ClipNode& node) override
    {
        if (node.getReferenceFrame() == osg::ClipNode::ABSOLUTE_RF) digestView();
        for (const auto& plane : node.getClipPlaneList())
            if (plane) _digest.add(plane->getClipPlaneNum(), plane->getClipPlane());
        enter(node);
    }

    osg::CullStack* asCullStack() override { return _cullStack.at(_sceneFromLocal); }
    const osg::CullStack* asCullStack() const override { return _cullStack.at(_sceneFromLocal); }

    void apply(osg::Drawable& drawable) override
    {
        addDrawable(drawable);
        traverse(drawable);
    }

    void apply(osg::Geometry& geometry) override
    {
        addDrawable(geometry);
        for (const float weight : SoftwareVertices::weightsOf(geometry))
            _digest.add(weight);
        _arrays.clear();
        geometry.getArrayList(_arrays);
        for (const auto& array : _arrays)
            _digest.add(array.get(), array->getModifiedCount(), array->getNumElements(),
                        array->getBinding());
        for (const auto& primitives : geometry.getPrimitiveSetList())
            _digest.add(primitives.get(), primitives->getModifiedCount(), primitives->getMode(),
                        hasTriangles(*primitives) ? primitives->getNumIndices() : 0u);
        traverse(geometry);
    }

    float getDistanceToEyePoint(const osg::Vec3& point, bool useLodScale) const override
    {
        const float scale = useLodScale && _view ? _view->lodScale : 1.0f;
        const osg::Vec3d eye = _eye * osg::Matrixd::inverse(_sceneFromLocal); // as in a cull traversal
        return static_cast<float>((osg::Vec3d(point) - eye).length()) * scale;
    }

    float getDistanceToViewPoint(const osg::Vec3& point, bool useLodScale) const override
    {
        return getDistanceToEyePoint(point, useLodScale);
    }

private:
    /// Of what turns to the view or moves with it.
    void digestView()
    {
        _digest.add(_eye);
        if (_view) _digest.addMatrix(_view->viewFromWorld);
    }

    void enter(osg::Node& node)
    {
        _digest.add(&node);
        addStateSetOf(node);
        if (getNodePath().size() < kDeepestPath) traverse(node);
        _digest.add(kEnd);
    }

    void addDrawable(const osg::Drawable& drawable)
    {
        _digest.add(&drawable);
        addStateSetOf(drawable);
        const osg::BoundingBox& box = drawable.getBoundingBox();
        _digest.add(box._min, box._max);
    }

    void addStateSetOf(const osg::Node& node)
    {
        _digest.add(node.getStateSet());
        if (node.getStateSet()) addStateSet(_digest, *node.getStateSet());
    }

    static constexpr int kEnd = -1; // of the children: a node that moves one level up must show

    Digest _digest;
    osg::Vec3d _eye;
    std::optional<ReferenceView> _view;
    ReferenceCullStack _cullStack;
    osg::Matrixd _sceneFromLocal;
    osg::Geometry::ArrayList _arrays;
};

} // namespace

uint64_t graphFingerprint(osg::Node& root, const ViewingConditions& conditions)
{
    FingerprintVisitor visitor(conditions);
    root.accept(visitor);
    return visitor.value();
}

} // namespace osgRayTrace::engine
