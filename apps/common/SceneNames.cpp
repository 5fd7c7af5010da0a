// SceneNames.cpp - collects names of nodes and of what their state sets hold. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/common/SceneNames.h"

#include <osg/Image>
#include <osg/Material>
#include <osg/NodeVisitor>
#include <osg/Program>
#include <osg/StateSet>
#include <osg/Texture>
#include <osg/Uniform>
#include <osg/UserDataContainer>

#include <map>
#include <set>
#include <tuple>

namespace osgRayTrace::app
{

namespace
{

/// Returns the text in one line and without tabs.
std::string plain(const std::string& text)
{
    std::string result;
    for (const char c : text)
    {
        if (c == '\t')
            result += "\\t";
        else if (c == '\n')
            result += "\\n";
        else if (c == '\\')
            result += "\\\\";
        else if (static_cast<unsigned char>(c) >= ' ')
            result += c;
    }
    return result;
}

std::string textOf(const osg::NodePath& path)
{
    std::string text;
    for (const osg::Node* node : path)
        text += (text.empty() ? "" : "/") +
                plain(node->getName().empty() ? node->className() : node->getName());
    return text;
}

const std::string kNoUnit = "-";

// The functions below call add(kind, name, unit) for each name.

template <class Add> void eachUserValue(const osg::Object& holder, const Add& add)
{
    const osg::UserDataContainer* container = holder.getUserDataContainer();
    if (!container) return;
    for (unsigned int i = 0; i < container->getNumUserObjects(); ++i)
        if (const osg::Object* value = container->getUserObject(i))
            if (!value->getName().empty()) add("user", value->getName(), kNoUnit);
}

template <class Add> void eachProgramName(const osg::StateAttribute& attribute, const Add& add)
{
    const auto* program = dynamic_cast<const osg::Program*>(&attribute);
    const std::string name = attribute.getName();
    add("program", !name.empty() || program ? name : attribute.className(), kNoUnit);
    for (unsigned int i = 0; program && i < program->getNumShaders(); ++i)
        if (!program->getShader(i)->getFileName().empty())
            add("shader", program->getShader(i)->getFileName(), kNoUnit);
}

template <class Add> void eachUniform(const osg::StateSet& stateSet, const Add& add)
{
    for (const auto& [name, pair] : stateSet.getUniformList())
    {
        int unit = 0;
        const bool isSampler = pair.first && pair.first->getIntArray() &&
                               osg::Uniform::getTypeNumComponents(pair.first->getType()) == 1 &&
                               pair.first->getElement(0, unit);
        if (isSampler)
            add("sampler", name, std::to_string(unit));
        else
            add("uniform", name, kNoUnit);
    }
}

template <class Add> void eachName(const osg::StateSet& stateSet, const Add& add)
{
    for (const auto& [type, pair] : stateSet.getAttributeList())
    {
        if (type.first == osg::StateAttribute::MATERIAL && !pair.first->getName().empty())
            add("material", pair.first->getName(), kNoUnit);
        if (type.first == osg::StateAttribute::PROGRAM) eachProgramName(*pair.first, add);
    }
    eachUniform(stateSet, add);
    const osg::StateSet::TextureAttributeList& units = stateSet.getTextureAttributeList();
    for (std::size_t unit = 0; unit < units.size(); ++unit)
        for (const auto& [type, pair] : units[unit])
        {
            const osg::Texture* texture = pair.first->asTexture();
            if (type.first != osg::StateAttribute::TEXTURE) continue;
            const osg::Image* image =
                texture && texture->getNumImages() > 0 ? texture->getImage(0) : nullptr;
            add("texture", image ? image->getFileName() : std::string(), std::to_string(unit));
        }
    eachUserValue(stateSet, add);
}

/// Calls add for each name that a node and its state set hold. The state set is left out if seen
/// says so.
template <class Seen, class Add>
void eachNameOf(const osg::Node& node, const Seen& seen, const Add& add)
{
    if (!node.getName().empty()) add("node", node.getName(), kNoUnit);
    eachUserValue(node, add);
    const osg::StateSet* stateSet = node.getStateSet();
    if (stateSet && !seen(*stateSet)) eachName(*stateSet, add);
}

/// Counts names, and keeps the first path to each.
class NameVisitor : public osg::NodeVisitor
{
public:
    NameVisitor() : osg::NodeVisitor(NODE_VISITOR, TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::Node& node) override
    {
        const auto seen = [this](const osg::Object& object)
        { return !_seen.insert(&object).second; };
        if (seen(node)) return;
        eachNameOf(node, seen,
                   [this](const std::string& kind, const std::string& name, const std::string& unit)
                   {
                       const auto [entry, isNew] = _names.try_emplace({kind, name, unit});
                       if (isNew) entry->second.path = textOf(getNodePath());
                       ++entry->second.count;
                   });
        if (getNodePath().size() < kDeepest) traverse(node);
    }

    std::string text() const
    {
        std::string lines;
        for (const auto& [key, entry] : _names)
        {
            const auto& [kind, name, unit] = key;
            lines += kind + "\t" + std::to_string(entry.count) + "\t" + plain(name) + "\t" + unit +
                     "\t" + entry.path + "\n";
        }
        return lines;
    }

private:
    static constexpr std::size_t kDeepest = 5000; ///< as in conversions

    struct Entry
    {
        std::size_t count = 0;
        std::string path;
    };

    std::set<const osg::Object*> _seen;
    std::map<std::tuple<std::string, std::string, std::string>, Entry> _names;
};

} // namespace

std::string namesOf(osg::Node& scene)
{
    NameVisitor visitor;
    scene.accept(visitor);
    return visitor.text();
}

std::string namesAlong(const osg::NodePath& path)
{
    std::string lines = textOf(path) + "\n";
    for (const osg::Node* node : path)
        eachNameOf(
            *node, [](const osg::Object&) { return false; },
            [&lines](const std::string& kind, const std::string& name, const std::string& unit)
            {
                if (kind != "node") lines += kind + "\t" + plain(name) + "\t" + unit + "\n";
            });
    return lines;
}

} // namespace osgRayTrace::app
