// MaterialAssignment.h - gives geometry the materials of a library or of the application. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/materials/HookAnswers.h"
#include "osgRayTrace/bridge/appearance/materials/MaterialLibrary.h"
#include "osgRayTrace/bridge/appearance/textures/DerivedTextures.h"
#include "osgRayTrace/bridge/common/ConversionReport.h"
#include "osgRayTrace/bridge/common/StateStack.h"

#include <osgRayTrace/MaterialHook>

#include <osg/StateSet>

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

/// Tells who gives a scene materials beside its own state.
struct MaterialGivers
{
    std::shared_ptr<const MaterialLibrary> rules;             ///< null: there are none
    osg::ref_ptr<MaterialHook> hook;                          ///< null: nobody is asked
    std::vector<osg::ref_ptr<const osg::StateSet>> inherited; ///< state sets above the root
};

/// Returns the rule of nodes, materials or textures for a geometry at the end of a path; null: none
/// fits.
const MaterialRule* ruleFor(const MaterialLibrary& rules, const osg::NodePath& path,
                            const GraphState& state);

/// Returns a copy of the state's PhysicalMaterial; without one, a new one with the diffuse colour
/// and texture of the state.
osg::ref_ptr<PhysicalMaterial> materialOfModel(const GraphState& state);

/// Tells which state a geometry is drawn with, and by whose wish.
struct AssignedState
{
    uint32_t state = 0;              ///< number in StateStack::states
    const std::string* by = nullptr; ///< rule that lets the geometry be traced; null: none
    VertexAttributes attributes;
    unsigned int unit = 0; ///< unit whose texture coordinates the material looks up
};

/// Assigns materials in one conversion.
class MaterialAssignment
{
public:
    /// derived holds textures of the last conversion and must live as long as this object.
    MaterialAssignment(MaterialGivers givers, DerivedTextures& derived)
        : _givers(std::move(givers)), _derived(derived)
    {
    }

    /// Returns the state with which a geometry at the end of the path is drawn: the top one, with a
    /// PhysicalMaterial if the hook knows one or a rule fits.
    AssignedState stateOf(const osg::NodePath& path, StateStack& states);

    /// Keeps the hook's answers from now on, and takes those that are there instead of asking
    /// again. The paths to come differ in their last node alone. Null: nothing is kept any more.
    void keepAnswers(HookAnswers* answers) { _answers = answers; }

    /// Takes the hook's answers from those that were kept: the hook is not asked any more. Such a
    /// path gets no material of the hook's if its answer is not there, see lacksAnswers().
    void repeatAnswers(HookAnswers& answers)
    {
        _answers = &answers;
        _repeats = true;
    }

    /// Returns whether an answer was wanted that was not there.
    bool lacksAnswers() const { return _lacksAnswers; }

    /// Names the rules that fitted nothing, and those that ask for what is not there.
    void reportRules(ConversionReport& report) const;

private:
    struct ShaderMatch
    {
        const ShaderRule* rule = nullptr; ///< null: none fits
        osg::ref_ptr<osg::StateSet> stateSet;
        unsigned int unit = 0;
    };

    osg::ref_ptr<PhysicalMaterial> ask(const osg::NodePath& path) const;
    osg::ref_ptr<PhysicalMaterial> hookMaterial(const osg::NodePath& path);
    const osg::StateSet* stateSetOf(const MaterialRule& rule, uint32_t number,
                                    const GraphState& state);
    const ShaderMatch& shaderMatch(const osg::NodePath& path, uint32_t number,
                                   const GraphState& state);

    const std::string _hookName = "material hook";
    MaterialGivers _givers;
    HookAnswers* _answers = nullptr; ///< null: each path is asked for
    bool _repeats = false;           ///< whether the answers are those of an earlier conversion
    bool _lacksAnswers = false;
    DerivedTextures& _derived;
    std::set<const MaterialRule*> _used;
    bool _usedShaders = false;
    /// By rule and state; null: the rule leaves the state as it is.
    std::map<std::pair<const MaterialRule*, uint32_t>, osg::ref_ptr<osg::StateSet>> _stateSets;
    std::map<uint32_t, ShaderMatch> _shaderMatches; ///< by state number
    std::map<const ShaderRule*, std::string> _missing;
};

} // namespace osgRayTrace::engine
