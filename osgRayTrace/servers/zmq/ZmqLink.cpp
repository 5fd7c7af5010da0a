// ZmqLink.cpp - a connection to a render server by ZeroMQ. Layer: servers.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/servers/Link.h"
#include "osgRayTrace/servers/zmq/ZmqKeys.h"

#include <zmq.h>

#include <memory>
#include <string>

namespace osgRayTrace::engine
{

namespace
{

/// The threads of ZeroMQ, which all links share. They are never ended: sockets of static objects
/// may close after everything else.
void* context()
{
    static void* const shared = zmq_ctx_new();
    return shared;
}

class ZmqLink : public Link
{
public:
    explicit ZmqLink(void* socket) : _socket(socket) {}
    ~ZmqLink() override { zmq_close(_socket); }

    bool send(const Bytes& message) override
    {
        return zmq_send(_socket, message.data(), message.size(), ZMQ_DONTWAIT) >= 0;
    }

    bool receive(Bytes& message) override
    {
        zmq_msg_t part;
        zmq_msg_init(&part);
        const bool came = zmq_msg_recv(&part, _socket, ZMQ_DONTWAIT) >= 0;
        if (came)
        {
            const auto* data = static_cast<const uint8_t*>(zmq_msg_data(&part));
            message.assign(data, data + zmq_msg_size(&part));
        }
        zmq_msg_close(&part);
        return came;
    }

private:
    void* _socket;
};

void setNumber(void* socket, int option, int value)
{
    zmq_setsockopt(socket, option, &value, sizeof value);
}

/// Sets the keys of a connection. Returns what is wrong; empty: nothing.
std::string setKeys(void* socket, const std::string& file)
{
    const std::string server = readKey(file);
    if (server.empty()) return "there is no key in '" + file + "'";
    char ownPublic[kKeyLength + 1], ownSecret[kKeyLength + 1];
    if (zmq_curve_keypair(ownPublic, ownSecret) != 0) return "this ZeroMQ has no CURVE";
    if (zmq_setsockopt(socket, ZMQ_CURVE_SERVERKEY, server.c_str(), server.size() + 1) != 0)
        return "what '" + file + "' has is no key";
    const bool set =
        zmq_setsockopt(socket, ZMQ_CURVE_PUBLICKEY, ownPublic, sizeof ownPublic) == 0 &&
        zmq_setsockopt(socket, ZMQ_CURVE_SECRETKEY, ownSecret, sizeof ownSecret) == 0;
    return set ? std::string() : std::string("this ZeroMQ takes no keys");
}

} // namespace

} // namespace osgRayTrace::engine

/// See OpenLink. The library finds this function by its name.
extern "C" __attribute__((visibility("default"))) osgRayTrace::engine::Link*
osgRayTraceOpenLink(const std::string& address, std::string& fault)
{
    using namespace osgRayTrace::engine;
    constexpr int64_t kLargestMessage = int64_t(1) << 29; // bytes; answers are tiles at most
    constexpr int kQueued = 0;                            // messages; 0: as many as memory holds
    void* const socket = zmq_socket(context(), ZMQ_DEALER);
    if (!socket)
    {
        fault = zmq_strerror(zmq_errno());
        return nullptr;
    }
    // What is sent while there is no connection is lost at once, and told: see Link.
    setNumber(socket, ZMQ_IMMEDIATE, 1);
    setNumber(socket, ZMQ_LINGER, 0);
    setNumber(socket, ZMQ_SNDHWM, kQueued);
    setNumber(socket, ZMQ_RCVHWM, kQueued);
    setNumber(socket, ZMQ_RECONNECT_IVL, 100); // [ms]
    zmq_setsockopt(socket, ZMQ_MAXMSGSIZE, &kLargestMessage, sizeof kLargestMessage);
    const std::size_t hash = address.find('#');
    if (hash != std::string::npos) fault = setKeys(socket, address.substr(hash + 1));
    if (fault.empty() && zmq_connect(socket, address.substr(0, hash).c_str()) != 0)
        fault = zmq_strerror(zmq_errno());
    if (fault.empty()) return std::make_unique<ZmqLink>(socket).release();
    zmq_close(socket);
    return nullptr;
}
