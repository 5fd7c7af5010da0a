// NodeTree.cpp - reads the hierarchy of nodes, and their transforms. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/NodeTree.h"

#include "osgPlugins/gltf/GltfError.h"
#include "osgRayTrace/base/NumberText.h"

namespace osgRayTrace::gltf
{

namespace
{

constexpr std::size_t kDeepest = 500; ///< traversals of OSG use the stack

} // namespace

osg::Matrix NodeTransform::toMatrix() const
{
    if (matrix) return *matrix;
    return osg::Matrix::scale(scale) * osg::Matrix::rotate(rotation) *
           osg::Matrix::translate(translation);
}

NodeTransform nodeTransform(const JsonPlace& node)
{
    NodeTransform transform;
    if (const auto matrix = node.find("matrix"))
        transform.matrix = osg::Matrix(matrix->numbers<16>().data());
    const auto t = node.numbersOr<3>("translation", {0.0f, 0.0f, 0.0f});
    const auto r = node.numbersOr<4>("rotation", {0.0f, 0.0f, 0.0f, 1.0f});
    const auto s = node.numbersOr<3>("scale", {1.0f, 1.0f, 1.0f});
    transform.translation.set(t[0], t[1], t[2]);
    transform.rotation.set(r[0], r[1], r[2], r[3]);
    const double length = transform.rotation.length();
    if (length > 0.0)
        transform.rotation /= length;
    else
        transform.rotation = osg::Quat();
    transform.scale.set(s[0], s[1], s[2]);
    return transform;
}

NodeTree::NodeTree(const Document& document)
    : _children(document.count("nodes")), _parents(document.count("nodes"), kNone)
{
    for (std::size_t node = 0; node < count(); ++node)
    {
        const JsonPlace place = document.element("nodes", node);
        for (std::size_t i = 0; i < place.sizeOf("children"); ++i)
        {
            const JsonPlace child = place.at("children")[i];
            const std::size_t index = child.index(count());
            if (_parents[index] != kNone)
                child.refuse("node " + std::to_string(index) + " is already below node " +
                             std::to_string(_parents[index]));
            _parents[index] = node;
            _children[node].push_back(index);
        }
    }
    checkDepths(document);
}

/// Walks up from each node; a node that is above itself is never at the top.
void NodeTree::checkDepths(const Document& document) const
{
    std::vector<std::size_t> depths(count(), kNone);
    std::vector<std::size_t> path;
    for (std::size_t first = 0; first < count(); ++first)
    {
        path.clear();
        std::size_t node = first;
        while (node != kNone && depths[node] == kNone && path.size() <= kDeepest)
        {
            path.push_back(node);
            node = _parents[node];
        }
        std::size_t depth = node != kNone && depths[node] != kNone ? depths[node] + 1 : 0;
        if (path.size() > kDeepest || depth + path.size() > kDeepest + 1)
            document.element("nodes", first)
                .refuse("has more than 500 nodes above it, or is above itself");
        for (auto at = path.rbegin(); at != path.rend(); ++at)
            depths[*at] = depth++;
    }
}

std::vector<std::size_t> NodeTree::roots(const Document& document) const
{
    std::vector<std::size_t> result;
    const auto scene = chosenScene(document);
    if (!scene)
    {
        for (std::size_t node = 0; node < count(); ++node)
            if (_parents[node] == kNone) result.push_back(node);
        return result;
    }
    std::vector<bool> listed(count(), false);
    for (std::size_t i = 0; i < scene->sizeOf("nodes"); ++i)
    {
        const JsonPlace place = scene->at("nodes")[i];
        const std::size_t node = place.index(count());
        if (listed[node]) place.refuse("is node " + std::to_string(node) + " again");
        if (_parents[node] != kNone)
            place.refuse("is node " + std::to_string(node) + ", which is below node " +
                         std::to_string(_parents[node]));
        listed[node] = true;
        result.push_back(node);
    }
    return result;
}

std::optional<JsonPlace> chosenScene(const Document& document)
{
    const std::size_t count = document.count("scenes");
    const std::string& wanted = document.options().scene;
    for (std::size_t i = 0; i < count && !wanted.empty(); ++i)
        if (document.element("scenes", i).textOr("name", "") == wanted)
            return document.element("scenes", i);
    if (!wanted.empty())
    {
        const auto number = engine::parseNumber<std::size_t>(wanted);
        if (!number || *number >= count)
            throw GltfError("option scene=" + wanted, "the file has " + std::to_string(count) +
                                                          " scenes, and none of this name");
        return document.element("scenes", *number);
    }
    const auto given = document.root().indexOf("scene", count);
    if (count == 0) return std::nullopt;
    return document.element("scenes", given.value_or(0));
}

} // namespace osgRayTrace::gltf
