// AnimationReader.cpp - makes a manager with an animation for each clip. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/AnimationReader.h"

#include "osgPlugins/gltf/Keys.h"

#include <osgAnimation/StackedMatrixElement>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedScaleElement>
#include <osgAnimation/StackedTranslateElement>

#include <algorithm>

namespace osgRayTrace::gltf
{

namespace
{

/// Returns the node whose values a channel changes; nothing if the channel has another target.
std::optional<std::size_t> targetNode(const JsonPlace& channel, std::size_t nodes)
{
    return channel.at("target").indexOf("node", nodes);
}

} // namespace

std::string transformTarget(std::size_t node)
{
    return "node" + std::to_string(node);
}

std::string weightsTarget(std::size_t node)
{
    return "weights" + std::to_string(node);
}

AnimationReader::AnimationReader(Document& document, const NodeTree& tree)
    : _document(&document), _movesNode(tree.count(), false), _changesWeights(tree.count(), false)
{
    for (std::size_t i = 0; i < document.count("animations"); ++i)
    {
        const JsonPlace channels = document.element("animations", i).at("channels");
        for (std::size_t k = 0; k < channels.size(); ++k)
        {
            const auto node = targetNode(channels[k], tree.count());
            if (!node) continue;
            const bool weights = channels[k].at("target").at("path").text() == "weights";
            (weights ? _changesWeights : _movesNode)[*node] = true;
        }
    }
}

std::vector<float> AnimationReader::lowestWeights(std::size_t node, AccessorReader& accessors) const
{
    std::vector<float> lowest;
    for (std::size_t i = 0; i < _document->count("animations"); ++i)
    {
        const JsonPlace place = _document->element("animations", i);
        const JsonPlace channels = place.at("channels"), samplers = place.at("samplers");
        for (std::size_t k = 0; k < channels.size(); ++k)
        {
            const JsonPlace channel = channels[k];
            if (targetNode(channel, _movesNode.size()) != node) continue;
            if (channel.at("target").at("path").text() != "weights") continue;
            const JsonPlace sampler = samplers[channel.at("sampler").index(samplers.size())];
            const std::vector<float> ofClip = lowestValues(readKeys(sampler, 1, accessors));
            lowest.resize(std::max(lowest.size(), ofClip.size()));
            for (std::size_t column = 0; column < ofClip.size(); ++column)
                lowest[column] = std::min(lowest[column], ofClip[column]);
        }
    }
    return lowest;
}

osg::ref_ptr<osgAnimation::Animation> AnimationReader::animation(const JsonPlace& place,
                                                                 AccessorReader& accessors) const
{
    const osg::ref_ptr<osgAnimation::Animation> animation = new osgAnimation::Animation;
    const auto add = [&](const osg::ref_ptr<osgAnimation::Channel>& channel,
                         const std::string& name, const std::string& target)
    {
        channel->setName(name);
        channel->setTargetName(target);
        animation->addChannel(channel.get());
    };
    const JsonPlace channels = place.at("channels");
    const JsonPlace samplers = place.at("samplers");
    for (std::size_t i = 0; i < channels.size(); ++i)
    {
        const JsonPlace channel = channels[i];
        const auto node = targetNode(channel, _movesNode.size());
        if (!node)
        {
            _document->note(channel.path() + ": has a target that is no node, and is left out");
            continue;
        }
        const JsonPlace sampler = samplers[channel.at("sampler").index(samplers.size())];
        const JsonPlace path = channel.at("target").at("path");
        if (path.text() == "rotation")
            add(rotationChannel(readKeys(sampler, 4, accessors)), "rotation",
                transformTarget(*node));
        else if (path.text() == "translation" || path.text() == "scale")
            add(vectorChannel(readKeys(sampler, 3, accessors)), path.text(),
                transformTarget(*node));
        else if (path.text() == "weights")
        {
            Keys keys = readKeys(sampler, 1, accessors);
            const auto shifts = _shifts.find(*node);
            if (shifts != _shifts.end()) shiftValues(shifts->second, keys);
            for (std::size_t column = 0; column < keys.width; ++column)
                add(weightChannel(keys, column), std::to_string(column), weightsTarget(*node));
        }
        else
            path.refuse("is '" + path.text() + "', which is nothing that can be animated");
    }
    return animation;
}

osg::ref_ptr<osgAnimation::BasicAnimationManager> AnimationReader::read(AccessorReader& accessors)
{
    const std::size_t count = _document->count("animations");
    if (count == 0) return nullptr;
    const osg::ref_ptr<osgAnimation::BasicAnimationManager> manager =
        new osgAnimation::BasicAnimationManager;
    for (std::size_t i = 0; i < count; ++i)
    {
        const JsonPlace place = _document->element("animations", i);
        const auto read = animation(place, accessors);
        read->setName(place.textOr("name", place.path()));
        manager->registerAnimation(read.get());
    }
    manager->playAnimation(manager->getAnimationList().front().get());
    return manager;
}

void setStack(const NodeTransform& transform, osgAnimation::UpdateMatrixTransform& callback)
{
    osgAnimation::StackedTransform& stack = callback.getStackedTransforms();
    if (transform.matrix)
    {
        stack.push_back(new osgAnimation::StackedMatrixElement("matrix", *transform.matrix));
        return;
    }
    stack.push_back(
        new osgAnimation::StackedTranslateElement("translation", transform.translation));
    stack.push_back(new osgAnimation::StackedQuaternionElement("rotation", transform.rotation));
    stack.push_back(new osgAnimation::StackedScaleElement("scale", transform.scale));
}

} // namespace osgRayTrace::gltf
