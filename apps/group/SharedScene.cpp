// SharedScene.cpp - an offer, answers of all, then the bytes. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/group/SharedScene.h"

#include <chrono>
#include <new>
#include <stdexcept>
#include <thread>

namespace osgRayTrace::app
{

namespace
{

using Kind = GroupMessage::Kind;

constexpr int kCannotRender = 3;  ///< exit code
constexpr double kSilence = 60.0; ///< time after which a rank is given up [s]

void rest()
{
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

void broadcast(Group& group, std::vector<unsigned char>& bytes)
{
    group.beginBroadcast(bytes.data(), bytes.size());
    // A part moves on only while somebody looks at it.
    while (!group.broadcastIsDone())
        std::this_thread::yield();
}

SendFailure failureOf(int rank, const std::string& host, const std::string& reason, int code)
{
    const std::string place = host.empty() ? "" : " on " + host;
    return {code != 0 ? code : kCannotRender, "rank " + std::to_string(rank) + place + reason};
}

} // namespace

SendFailure sendScene(Group& group, SentScene& scene, const std::function<double()>& now)
{
    GroupMessage offer(Kind::Scene);
    offer.first = scene.width;
    offer.end = scene.height;
    offer.bytes = scene.bytes.size();
    for (int rank = 1; rank < group.size(); ++rank)
        group.send(rank, offer);

    std::vector<bool> hasRoom(static_cast<std::size_t>(group.size()), false);
    const double begin = now();
    for (int missing = group.size() - 1; missing > 0;)
    {
        const auto received = group.receive();
        if (!received && now() - begin > kSilence)
            for (int rank = 1; rank < group.size(); ++rank)
                if (!hasRoom[static_cast<std::size_t>(rank)])
                    return failureOf(rank, {}, " does not answer", 0);
        if (!received)
        {
            rest();
            continue;
        }
        const auto& [rank, message] = *received;
        if (message.kind == Kind::Failed)
            return failureOf(rank, message.host, ": " + message.text, message.first);
        if (message.kind != Kind::Room) continue;
        hasRoom[static_cast<std::size_t>(rank)] = true;
        --missing;
    }
    for (int rank = 1; rank < group.size(); ++rank)
        group.send(rank, GroupMessage(Kind::Bytes));
    broadcast(group, scene.bytes);
    return {};
}

std::optional<SentScene> receiveScene(Group& group)
{
    SentScene scene;
    while (true)
    {
        const auto received = group.receive();
        if (!received)
        {
            rest();
            continue;
        }
        const GroupMessage& message = received->second;
        if (message.kind == Kind::End) return std::nullopt;
        if (message.kind == Kind::Abort) group.abort(kCannotRender);
        if (message.kind == Kind::Scene)
        {
            scene.width = message.first;
            scene.height = message.end;
            try
            {
                scene.bytes.resize(message.bytes);
            }
            catch (const std::exception&)
            {
                throw std::runtime_error("there is not enough memory for the scene of " +
                                         std::to_string(message.bytes) + " bytes");
            }
            group.send(0, GroupMessage(Kind::Room));
        }
        if (message.kind != Kind::Bytes) continue;
        broadcast(group, scene.bytes);
        return scene;
    }
}

} // namespace osgRayTrace::app
