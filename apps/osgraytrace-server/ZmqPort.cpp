// ZmqPort.cpp - where a render server hears its viewers, by ZeroMQ. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytrace-server/ZmqPort.h"

#include "osgRayTrace/servers/zmq/ZmqKeys.h"

#include <zmq.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace osgRayTrace::app
{

namespace
{

/// A viewer's messages are scenes at most.
constexpr int64_t kLargestMessage = int64_t(1) << 36; // bytes

void setNumber(void* socket, int option, int value)
{
    zmq_setsockopt(socket, option, &value, sizeof value);
}

/// Reads a part of a message. Returns false if there is none.
bool receivePart(void* socket, zmq_msg_t& part, bool& more)
{
    zmq_msg_init(&part);
    if (zmq_msg_recv(&part, socket, ZMQ_DONTWAIT) < 0)
    {
        zmq_msg_close(&part);
        return false;
    }
    more = zmq_msg_more(&part) != 0;
    return true;
}

void writeKey(const std::string& file, const char* key, int mode)
{
    const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL, mode);
    const std::string line = std::string(key) + "\n";
    const bool written = descriptor >= 0 && write(descriptor, line.data(), line.size()) ==
                                                static_cast<ssize_t>(line.size());
    const std::string reason = std::strerror(errno);
    if (descriptor >= 0) close(descriptor);
    if (!written) throw std::runtime_error("cannot write " + file + ": " + reason);
}

} // namespace

ZmqPort::ZmqPort(const std::string& address, const std::string& secretKeyFile)
    : _context(zmq_ctx_new()), _socket(zmq_socket(_context, ZMQ_ROUTER))
{
    setNumber(_socket, ZMQ_LINGER, 100); // [ms]
    setNumber(_socket, ZMQ_SNDHWM, 0);
    setNumber(_socket, ZMQ_RCVHWM, 0);
    zmq_setsockopt(_socket, ZMQ_MAXMSGSIZE, &kLargestMessage, sizeof kLargestMessage);
    std::string fault;
    if (!secretKeyFile.empty())
    {
        const std::string key = engine::readKey(secretKeyFile);
        setNumber(_socket, ZMQ_CURVE_SERVER, 1);
        if (key.empty())
            fault = "there is no key in '" + secretKeyFile + "'";
        else if (zmq_setsockopt(_socket, ZMQ_CURVE_SECRETKEY, key.c_str(), key.size() + 1) != 0)
            fault = "this ZeroMQ has no CURVE, or '" + secretKeyFile + "' has no key";
    }
    if (fault.empty() && zmq_bind(_socket, address.c_str()) != 0)
        fault = "cannot listen at " + address + ": " + zmq_strerror(zmq_errno());
    if (fault.empty()) return;
    zmq_close(_socket);
    zmq_ctx_term(_context);
    throw std::runtime_error(fault);
}

ZmqPort::~ZmqPort()
{
    zmq_close(_socket);
    zmq_ctx_term(_context);
}

bool ZmqPort::receive(std::string& viewer, engine::Bytes& message)
{
    zmq_msg_t part;
    bool more = false;
    if (!receivePart(_socket, part, more)) return false;
    viewer.assign(static_cast<const char*>(zmq_msg_data(&part)), zmq_msg_size(&part));
    zmq_msg_close(&part);
    message.clear();
    while (more && receivePart(_socket, part, more)) // of a viewer, one
    {
        const auto* data = static_cast<const uint8_t*>(zmq_msg_data(&part));
        message.assign(data, data + zmq_msg_size(&part));
        zmq_msg_close(&part);
    }
    return true;
}

void ZmqPort::send(const std::string& viewer, engine::Bytes&& message)
{
    if (zmq_send(_socket, viewer.data(), viewer.size(), ZMQ_SNDMORE | ZMQ_DONTWAIT) < 0) return;
    // ZeroMQ frees the bytes when they are on their way, on a thread of its own.
    auto* kept = new engine::Bytes(std::move(message));
    const auto forget = [](void*, void* bytes) { delete static_cast<engine::Bytes*>(bytes); };
    zmq_msg_t part;
    zmq_msg_init_data(&part, kept->data(), kept->size(), forget, kept);
    if (zmq_msg_send(&part, _socket, ZMQ_DONTWAIT) < 0) zmq_msg_close(&part);
}

void ZmqPort::wait(int milliseconds)
{
    zmq_pollitem_t item{_socket, 0, ZMQ_POLLIN, 0};
    zmq_poll(&item, 1, milliseconds);
}

std::string ZmqPort::address() const
{
    char text[256] = "";
    std::size_t size = sizeof text;
    zmq_getsockopt(_socket, ZMQ_LAST_ENDPOINT, text, &size);
    return text;
}

void ZmqPort::makeKeys(const std::string& prefix)
{
    char publicKey[engine::kKeyLength + 1], secretKey[engine::kKeyLength + 1];
    if (zmq_curve_keypair(publicKey, secretKey) != 0)
        throw std::runtime_error("this ZeroMQ has no CURVE");
    writeKey(prefix + ".secret", secretKey, S_IRUSR | S_IWUSR);
    writeKey(prefix + ".public", publicKey, S_IRUSR | S_IWUSR | S_IRGRP | S_IROTH);
}

} // namespace osgRayTrace::app
