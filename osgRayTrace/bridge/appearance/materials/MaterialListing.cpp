// MaterialListing.cpp - names and values of the materials of a graph. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/materials/MaterialListing.h"

#include "osgRayTrace/base/NumberText.h"
#include "osgRayTrace/bridge/appearance/materials/MaterialAssignment.h"
#include "osgRayTrace/bridge/appearance/materials/RuleMaterial.h"

#include <nlohmann/json.hpp>
#include <osg/Geometry>
#include <osg/Image>
#include <osg/Material>
#include <osg/NodeVisitor>

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

using Json = nlohmann::json;

/// Calls use(path, state) for each geometry. A node that was met in the same state below the same
/// chain of names is passed by. Ends after as many visits as conversions do.
class GeometryVisitor : public osg::NodeVisitor
{
public:
    using Use = std::function<void(const osg::NodePath&, const GraphState&)>;

    GeometryVisitor(const Use& use, std::size_t mostVisits)
        : osg::NodeVisitor(NODE_VISITOR, TRAVERSE_ALL_CHILDREN),
          _use(use),
          _mostVisits(mostVisits),
          _states(GraphState())
    {
    }

    void apply(osg::Node& node) override
    {
        const osg::StateSet* stateSet = node.getStateSet();
        if (stateSet) _states.push(*stateSet);
        const uint32_t state = _states.top(), chainAbove = _chain;
        if (!node.getName().empty()) _chain = chainWith(node.getName());
        if (getNodePath().size() >= kDeepest || _seen.size() >= _mostVisits)
            _complete = false;
        else if (_seen.insert({&node, state, _chain}).second)
        {
            if (node.asGeometry())
                _use(getNodePath(), _states.states()[state]);
            else
                traverse(node);
        }
        _chain = chainAbove;
        if (stateSet) _states.pop();
    }

    /// Returns false if the traversal has left something out.
    bool isComplete() const { return _complete; }

private:
    static constexpr std::size_t kDeepest = 5000; ///< as in conversions

    /// Returns the number of the chain of names that goes on with this name.
    uint32_t chainWith(const std::string& name)
    {
        const auto next = static_cast<uint32_t>(_chains.size() + 1);
        return _chains.try_emplace({_chain, name}, next).first->second;
    }

    const Use& _use;
    std::size_t _mostVisits;
    bool _complete = true;
    StateStack _states;
    uint32_t _chain = 0; ///< of the names above; 0: there is none
    std::map<std::pair<uint32_t, std::string>, uint32_t> _chains;
    std::set<std::tuple<const osg::Node*, uint32_t, uint32_t>> _seen;
};

/// Holds a graph and how many of its nodes are visited at most.
struct Listed
{
    osg::Node& scene;
    std::size_t mostVisits;
};

/// Calls use for each geometry; returns false if some were left out.
bool eachGeometry(const Listed& listed, const GeometryVisitor::Use& use)
{
    GeometryVisitor visitor(use, listed.mostVisits);
    listed.scene.accept(visitor);
    return visitor.isComplete();
}

/// Returns the name as text of JSON; nothing if it cannot be a name in a file.
std::optional<std::string> quoted(const std::string& name)
{
    if (name.empty() || name.find('*') != std::string::npos) return std::nullopt;
    try
    {
        return Json(name).dump();
    }
    catch (const Json::exception&) // no UTF-8
    {
        return std::nullopt;
    }
}

struct EntryName
{
    const char* group = nullptr; ///< null: there is no name
    std::string name;
};

/// Returns the name of the material, or of its texture.
EntryName ownName(const GraphState& state)
{
    const auto* material = state.attribute<osg::Material>(kMaterialSlot);
    if (material && quoted(material->getName())) return {"materials", material->getName()};
    const osg::Texture2D* texture = textureOf(state);
    if (texture && texture->getImage() && quoted(texture->getImage()->getFileName()))
        return {"textures", texture->getImage()->getFileName()};
    return {};
}

/// Returns the name of the nearest node with a name, unless it is among the taken ones.
EntryName nodeName(const osg::NodePath& path, const std::set<std::string>& taken)
{
    for (auto node = path.rbegin(); node != path.rend(); ++node)
    {
        const std::string& name = (*node)->getName();
        if (name.empty()) continue;
        return quoted(name) && taken.count(name) == 0 ? EntryName{"nodes", name} : EntryName{};
    }
    return {};
}

MaterialRuleList& groupOf(const std::string& name, MaterialLibrary& library)
{
    return name == "nodes"       ? library.nodes
           : name == "materials" ? library.materials
                                 : library.textures;
}

/// Returns the entries that a file needs, without values.
MaterialLibrary entriesOf(const Listed& listed)
{
    MaterialLibrary library;
    const auto add = [&library](const EntryName& entry)
    {
        if (entry.group)
            groupOf(entry.group, library).add({entry.group, entry.name, nullptr, true, false, {}});
    };
    std::set<std::string> taken; // names of nodes above geometries with a name of their own
    eachGeometry(listed,
                 [&](const osg::NodePath& path, const GraphState& state)
                 {
                     const EntryName name = ownName(state);
                     if (!name.group) return;
                     add(name);
                     for (const osg::Node* node : path)
                         taken.insert(node->getName());
                 });
    eachGeometry(listed,
                 [&](const osg::NodePath& path, const GraphState& state)
                 {
                     if (!ownName(state).group) add(nodeName(path, taken));
                 });
    return library;
}

/// Returns the shortest texts that read as the same floats.
std::string valueText(const Values& values)
{
    if (values.size() == 1) return numberText(static_cast<float>(values[0]));
    std::string text;
    for (const double value : values)
        text += (text.empty() ? "[" : ", ") + numberText(static_cast<float>(value));
    return text + "]";
}

/// The first parameters stand in each entry, the others if they are not the default.
constexpr std::size_t kAlwaysListed = 7;

/// Returns the lines of the material's parameters.
std::string parameterLines(const PhysicalMaterial& material)
{
    const osg::ref_ptr<PhysicalMaterial> plain = new PhysicalMaterial;
    const std::vector<const Parameter*>& parameters = allParameters();
    std::string lines;
    for (std::size_t i = 0; i < parameters.size(); ++i)
    {
        const Values values = parameters[i]->get(material);
        if (i >= kAlwaysListed && values == parameters[i]->get(*plain)) continue;
        lines += std::string(",\n      \"") + parameters[i]->name + "\": " + valueText(values);
    }
    return lines;
}

/// Returns the parameters of each entry: none if those of its geometries differ.
std::map<const MaterialRule*, std::string>
valuesOf(const Listed& listed, const MaterialLibrary& library, MaterialListing& listing)
{
    std::map<const MaterialRule*, std::string> values;
    listing.complete = eachGeometry(listed,
                                    [&](const osg::NodePath& path, const GraphState& state)
                                    {
                                        const MaterialRule* rule = ruleFor(library, path, state);
                                        if (!rule)
                                        {
                                            ++listing.nameless;
                                            return;
                                        }
                                        const std::string lines =
                                            parameterLines(*materialOfModel(state));
                                        const auto [known, isNew] = values.try_emplace(rule, lines);
                                        if (!isNew && known->second != lines) known->second.clear();
                                    });
    return values;
}

} // namespace

MaterialListing listMaterials(osg::Node& scene, std::size_t mostVisits)
{
    MaterialListing listing;
    const Listed listed{scene, mostVisits};
    const MaterialLibrary library = entriesOf(listed);
    const auto values = valuesOf(listed, library, listing);
    std::string groups;
    for (const auto& [group, list] :
         {std::make_pair("nodes", &library.nodes), std::make_pair("materials", &library.materials),
          std::make_pair("textures", &library.textures)})
    {
        std::map<std::string, std::string> entries; // sorted by name
        for (const MaterialRule& rule : *list)
            if (const auto known = values.find(&rule); known != values.end())
                entries.emplace(*quoted(rule.pattern), known->second);
        listing.entries += entries.size();
        std::string text;
        for (const auto& [name, lines] : entries)
            text += (text.empty() ? "\n    " : ",\n    ") + name + ": {\n      \"edits\": 1" +
                    lines + "\n    }";
        if (!text.empty())
            groups += std::string(groups.empty() ? "" : ",") + "\n  \"" + group + "\": {" + text +
                      "\n  }";
    }
    listing.text = "{" + groups + "\n}\n";
    return listing;
}

} // namespace osgRayTrace::engine
