// ShaderState.h - the inherited uniforms and textures that a program reads. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/StateSet>
#include <osg/Uniform>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

/// Holds what programs read of the inherited state. A texture counts whatever its modes are, as it
/// does below a program. The objects live as long as those of GraphState.
struct ShaderState
{
    template <class T> using Pair = std::pair<const T*, osg::StateAttribute::OverrideValue>;

    std::map<std::string, Pair<osg::Uniform>> uniforms;         ///< by name
    std::map<unsigned int, Pair<osg::StateAttribute>> textures; ///< by unit, of type TEXTURE
};

/// Returns the state below a state set: the same object if the set changes nothing in it.
std::shared_ptr<const ShaderState> below(const std::shared_ptr<const ShaderState>& state,
                                         const osg::StateSet& stateSet);

/// Lists the values that the rules of a material file read, so that their changes are noticed.
struct ShaderReads
{
    std::vector<std::string> uniforms; ///< patterns
    bool userValues = false;           ///< true: any user value of a state set
    bool attributes = false;           ///< true: vertex attributes in the place of fixed arrays

    bool reads(const osg::Uniform& uniform) const;
};

/// Returns the components of the first element of a uniform; empty for matrices.
std::vector<double> valuesOf(const osg::Uniform& uniform);

/// Returns the numbers of a user value; those of a text if it begins with numbers; empty for an
/// object without any.
std::vector<double> userValuesOf(const osg::Object& userValue);

} // namespace osgRayTrace::engine
