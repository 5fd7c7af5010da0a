// MaterialAssignment.h - gives geometry the materials of a library. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/materials/MaterialLibrary.h"
#include "osgRayTrace/bridge/common/ConversionReport.h"
#include "osgRayTrace/bridge/common/StateStack.h"

#include <osg/StateSet>

#include <map>
#include <set>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

/// Assigns materials in one conversion. A library that is null has no rules.
class MaterialAssignment
{
public:
    explicit MaterialAssignment(std::shared_ptr<const MaterialLibrary> library)
        : _library(std::move(library))
    {
    }

    /// Returns the number in states of the state with which a geometry at the end of the path is
    /// drawn: the top one, with a PhysicalMaterial if a rule fits.
    uint32_t stateOf(const osg::NodePath& path, StateStack& states);

    /// Names the rules that fitted nothing.
    void reportUnused(ConversionReport& report) const;

private:
    const MaterialRule* ruleFor(const osg::NodePath& path, const GraphState& state) const;
    const osg::StateSet& stateSetOf(const MaterialRule& rule, uint32_t number,
                                    const GraphState& state);

    std::shared_ptr<const MaterialLibrary> _library;
    std::set<const MaterialRule*> _used;
    std::map<std::pair<const MaterialRule*, uint32_t>, osg::ref_ptr<osg::StateSet>> _stateSets;
};

} // namespace osgRayTrace::engine
