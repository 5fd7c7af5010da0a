// HookAnswers.h - what the application's MaterialHook has answered for drawables of a cull
// traversal. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/PhysicalMaterial>

#include <osg/Node>

#include <map>
#include <utility>

namespace osgRayTrace::engine
{

/// Holds the answers for the drawables below one node, which are kept alive. Updates repeat cull
/// traversals between conversions, but a hook is asked in conversions only.
class HookAnswers
{
public:
    /// Returns the answer for a drawable, which may be a null material; null: it was not asked for.
    const osg::ref_ptr<PhysicalMaterial>* find(const osg::Node& drawable) const
    {
        const auto found = _answers.find(&drawable);
        return found == _answers.end() ? nullptr : &found->second;
    }

    const osg::ref_ptr<PhysicalMaterial>& add(const osg::Node& drawable,
                                              osg::ref_ptr<PhysicalMaterial> material)
    {
        return _answers[&drawable] = std::move(material);
    }

private:
    std::map<osg::ref_ptr<const osg::Node>, osg::ref_ptr<PhysicalMaterial>> _answers;
};

} // namespace osgRayTrace::engine
