// CullNodes.h - stand-ins for nodes of applications that draw or push state in cull. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/GLExtensions>
#include <osg/Geode>
#include <osg/Light>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osg/State>
#include <osg/StateAttribute>
#include <osg/Transform>
#include <osgUtil/CullVisitor>

#include <array>
#include <stdexcept>
#include <vector>

/// The namespace is not osgRayTrace, as the classes stand for those of an application.
namespace application
{

/// Draws its content in cull traversals only, like osgEarth's terrain.
class CullDrawn : public osg::Group
{
public:
    explicit CullDrawn(osg::Node* drawn) : content(drawn) {}

    void traverse(osg::NodeVisitor& visitor) override
    {
        if (visitor.getVisitorType() == osg::NodeVisitor::CULL_VISITOR) content->accept(visitor);
    }
    osg::BoundingSphere computeBound() const override { return content->getBound(); }

    osg::ref_ptr<osg::Node> content;
};

/// Pushes one of two state sets, which take turns from frame to frame, like OpenMW's callbacks.
class StatePusher : public osg::NodeCallback
{
public:
    StatePusher(osg::ref_ptr<osg::StateSet> even, osg::ref_ptr<osg::StateSet> odd)
        : states{std::move(even), std::move(odd)}
    {
    }

    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        osgUtil::CullVisitor* cull = visitor->asCullVisitor();
        if (cull) cull->pushStateSet(states[visitor->getTraversalNumber() % 2].get());
        traverse(node, visitor);
        if (cull) cull->popStateSet();
    }

    std::array<osg::ref_ptr<osg::StateSet>, 2> states;
};

/// Shows its children, or hides them from the view.
class Passing : public osg::NodeCallback
{
public:
    explicit Passing(bool hides) : _hides(hides) {}

    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        if (!_hides) traverse(node, visitor);
    }

private:
    bool _hides;
};

/// Moves what is below to the eye of a cull visitor alone, as examples of OSG do with their skies.
class EyeFollower : public osg::Transform
{
public:
    bool computeLocalToWorldMatrix(osg::Matrix& matrix, osg::NodeVisitor* visitor) const override
    {
        if (const osgUtil::CullVisitor* cull = visitor ? visitor->asCullVisitor() : nullptr)
            matrix.preMultTranslate(osg::Vec3(cull->getEyeLocal()));
        return true;
    }
};

class Throwing : public osg::NodeCallback
{
public:
    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        if (throws > 0 && throws-- > 0) throw std::runtime_error("no traversal of mine");
        traverse(node, visitor);
    }

    int throws = 0; ///< number of traversals to come that throw
};

/// Holds drawables whose state is known to EffectCullVisitor alone, like FlightGear's.
class EffectGeode : public osg::Geode
{
public:
    osg::ref_ptr<osg::StateSet> effect;
};

class EffectCullVisitor : public osgUtil::CullVisitor
{
public:
    EffectCullVisitor() = default;
    EffectCullVisitor(const EffectCullVisitor& other) = default;
    osgUtil::CullVisitor* clone() const override { return new EffectCullVisitor(*this); }

    using osgUtil::CullVisitor::apply;
    void apply(osg::Geode& node) override
    {
        auto* geode = dynamic_cast<EffectGeode*>(&node);
        if (geode) pushStateSet(geode->effect.get());
        osgUtil::CullVisitor::apply(node);
        if (geode) popStateSet();
    }
};

/// Is of the type of programs without being an osg::Program, like osgEarth's class of this name. It
/// leaves drawing to the fixed function.
class VirtualProgram : public osg::StateAttribute
{
public:
    VirtualProgram() = default;
    VirtualProgram(const VirtualProgram& other, const osg::CopyOp& copyop)
        : osg::StateAttribute(other, copyop)
    {
    }
    META_StateAttribute(application, VirtualProgram, PROGRAM);
    int compare(const osg::StateAttribute& other) const override
    {
        COMPARE_StateAttribute_Types(VirtualProgram, other);
        static_cast<void>(rhs);
        return 0;
    }
    void apply(osg::State& state) const override
    {
        state.get<osg::GLExtensions>()->glUseProgram(0);
        state.setLastAppliedProgramObject(nullptr);
    }
};

/// Draws one of two geometries, which take turns from frame to frame and are written in cull, like
/// OpenMW's rigs.
class RigDrawable : public osg::Drawable
{
public:
    explicit RigDrawable(const osg::Geometry& source)
    {
        for (osg::ref_ptr<osg::Geometry>& pose : _poses)
            pose = new osg::Geometry(source, osg::CopyOp::DEEP_COPY_ARRAYS);
        _rest = new osg::Vec3Array(static_cast<const osg::Vec3Array&>(*source.getVertexArray()));
        setCullingActive(false);
    }

    using osg::Drawable::accept;
    void accept(osg::NodeVisitor& visitor) override
    {
        if (visitor.getVisitorType() != osg::NodeVisitor::CULL_VISITOR)
            return osg::Drawable::accept(visitor);
        if (!visitor.validNodeMask(*this) || hidden) return;
        visitor.pushOntoNodePath(this);
        if (visitor.getTraversalNumber() != _frame) setPose(visitor.getTraversalNumber());
        visitor.pushOntoNodePath(&chosen());
        visitor.apply(chosen());
        visitor.popFromNodePath();
        visitor.popFromNodePath();
    }
    osg::BoundingBox computeBoundingBox() const override
    {
        const osg::Vec3 reach(3.0f, 3.0f, 3.0f);
        return {shift - reach, shift + reach};
    }
    bool supports(const osg::PrimitiveFunctor&) const override { return true; }
    void accept(osg::PrimitiveFunctor& functor) const override { chosen().accept(functor); }
    osg::Geometry& chosen() const { return pose(_frame); }
    osg::Geometry& pose(unsigned int frame) const { return *_poses[frame % 2]; }
    void bend(const osg::Vec3& to)
    {
        shift = to;
        dirtyBound();
    }

    osg::Vec3 shift; ///< moves all vertices
    bool hidden = false;

private:
    void setPose(unsigned int frame)
    {
        _frame = frame;
        auto& vertices = static_cast<osg::Vec3Array&>(*chosen().getVertexArray());
        for (std::size_t i = 0; i < vertices.size(); ++i)
            vertices[i] = (*_rest)[i] + shift;
        vertices.dirty();
        chosen().dirtyBound();
    }

    std::array<osg::ref_ptr<osg::Geometry>, 2> _poses;
    osg::ref_ptr<osg::Vec3Array> _rest;
    unsigned int _frame = 0;
};

/// Holds the lights of the frame, which nodes of the application add in update traversals.
class LightManager : public osg::Group
{
public:
    std::vector<osg::ref_ptr<osg::Light>> lights; ///< in world space
    unsigned int frame = 0;
};

/// Adds its light to a manager in each frame.
class ManagedLight : public osg::NodeCallback
{
public:
    ManagedLight(LightManager& manager, osg::Light& light) : _manager(manager), _light(&light) {}

    void operator()(osg::Node*, osg::NodeVisitor* visitor) override
    {
        if (_manager.frame != visitor->getTraversalNumber()) _manager.lights.clear();
        _manager.frame = visitor->getTraversalNumber();
        _manager.lights.push_back(_light);
    }

private:
    LightManager& _manager;
    osg::ref_ptr<osg::Light> _light;
};

/// Applies several lights, given in world space.
class LightsAttribute : public osg::StateAttribute
{
public:
    LightsAttribute() = default;
    LightsAttribute(const LightsAttribute& other, const osg::CopyOp& copyop)
        : osg::StateAttribute(other, copyop), lights(other.lights)
    {
    }
    META_StateAttribute(application, LightsAttribute, LIGHT);
    unsigned int getMember() const override { return 1; }
    bool getModeUsage(ModeUsage& usage) const override
    {
        for (std::size_t i = 0; i < lights.size(); ++i)
            usage.usesMode(GLMode(GL_LIGHT1 + i));
        return true;
    }
    int compare(const osg::StateAttribute& other) const override
    {
        COMPARE_StateAttribute_Types(LightsAttribute, other);
        return lights == rhs.lights ? 0 : lights < rhs.lights ? -1 : 1;
    }
    void apply(osg::State& state) const override
    {
        const osg::Matrix modelView = state.getModelViewMatrix();
        state.applyModelViewMatrix(state.getInitialViewMatrix());
        for (const osg::ref_ptr<osg::Light>& light : lights)
            light->apply(state);
        state.applyModelViewMatrix(modelView);
    }

    std::vector<osg::ref_ptr<osg::Light>> lights;
};

/// Lights what is below it by the lights of a manager, in cull alone, like OpenMW's callback.
class LightListCallback : public osg::NodeCallback
{
public:
    explicit LightListCallback(LightManager& manager) : _manager(manager) {}

    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        osgUtil::CullVisitor* cull = visitor->asCullVisitor();
        osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
        osg::ref_ptr<LightsAttribute> attribute = new LightsAttribute;
        attribute->lights = _manager.lights;
        state->setAttributeAndModes(attribute.get());
        if (cull) cull->pushStateSet(state.get());
        traverse(node, visitor);
        if (cull) cull->popStateSet();
    }

private:
    LightManager& _manager;
};

struct CountedDraws : osg::Drawable::DrawCallback
{
    void drawImplementation(osg::RenderInfo& info, const osg::Drawable* drawable) const override
    {
        ++draws;
        drawable->drawImplementation(info);
    }
    mutable int draws = 0;
};

inline osg::ref_ptr<osg::MatrixTransform> raised(osg::Node* node, float height)
{
    osg::ref_ptr<osg::MatrixTransform> transform =
        new osg::MatrixTransform(osg::Matrix::translate(0.0, 0.0, height));
    transform->addChild(node);
    return transform;
}

/// Returns state that gives what is lit this colour alone.
inline osg::ref_ptr<osg::StateSet> unlitColor(const osg::Vec4& color)
{
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(0, 0, 0, 1));
    material->setAmbient(osg::Material::FRONT_AND_BACK, osg::Vec4(0, 0, 0, 1));
    material->setEmission(osg::Material::FRONT_AND_BACK, color);
    state->setAttributeAndModes(material.get());
    state->setMode(GL_LIGHTING, osg::StateAttribute::ON);
    return state;
}

} // namespace application
