// Wire.h - values as bytes and back, for messages between processes of one kind. Layer: servers.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

/// Leaves the bytes that a vector grows by as they are: messages are written at once.
template <class T> struct UnclearedAllocator : std::allocator<T>
{
    template <class U> struct rebind
    {
        using other = UnclearedAllocator<U>;
    };
    template <class U> void construct(U* place) { ::new (static_cast<void*>(place)) U; }
    template <class U, class... Values> void construct(U* place, Values&&... values)
    {
        ::new (static_cast<void*>(place)) U(std::forward<Values>(values)...);
    }
};

using Bytes = std::vector<uint8_t, UnclearedAllocator<uint8_t>>;

/// The last enumerator of an enumeration that counts from 0: a specialisation for each that
/// messages hold, with a member `value`.
template <class Enum> struct LastEnumerator;

/// Appends values to a message, in this processor's byte order: the hello of a connection compares
/// versions and processors.
class WireWriter
{
public:
    explicit WireWriter(Bytes& bytes) : _bytes(bytes) {}

    template <class... T> void operator()(const T&... values) { (put(values), ...); }

    template <class T> void array(const T* values, std::size_t count)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        put(static_cast<uint64_t>(count));
        append(values, count * sizeof(T));
    }
    template <class T> void array(const std::vector<T>& values)
    {
        array(values.data(), values.size());
    }
    void text(const std::string& text) { array(text.data(), text.size()); }

    void append(const void* data, std::size_t size)
    {
        if (size == 0) return;
        const std::size_t end = _bytes.size();
        _bytes.resize(end + size);
        std::memcpy(_bytes.data() + end, data, size);
    }

private:
    template <class T> void put(const T& value)
    {
        static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
        if constexpr (std::is_same_v<T, bool>)
            _bytes.push_back(static_cast<uint8_t>(value));
        else
            append(&value, sizeof value);
    }

    Bytes& _bytes;
};

/// Takes values from a message that may be damaged: a value that is not there, or that no value of
/// its type is, makes good() false for good, and the value is left as it was.
class WireReader
{
public:
    WireReader(const uint8_t* data, std::size_t size) : _at(data), _left(size) {}
    explicit WireReader(const Bytes& bytes) : WireReader(bytes.data(), bytes.size()) {}

    template <class... T> void operator()(T&... values) { (take(values), ...); }

    /// Reads an array. No memory is taken for more values than the message has bytes for.
    template <class T> void array(std::vector<T>& values)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        uint64_t count = 0;
        take(count);
        if (!_good || count > _left / sizeof(T)) return fail();
        values.resize(static_cast<std::size_t>(count));
        copy(values.data(), values.size() * sizeof(T));
    }
    void text(std::string& text)
    {
        std::vector<char> characters;
        array(characters);
        text.assign(characters.begin(), characters.end());
    }

    /// Reads memory of a known size. Returns false, and leaves it, if the message is too short.
    bool copy(void* data, std::size_t size)
    {
        if (!_good || size > _left) return fail(), false;
        if (size > 0) std::memcpy(data, _at, size);
        _at += size;
        _left -= size;
        return true;
    }

    bool good() const { return _good; }
    std::size_t left() const { return _left; }
    void fail() { _good = false; }

private:
    template <class T> void take(T& value)
    {
        static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
        if constexpr (std::is_same_v<T, bool>)
        {
            uint8_t byte = 0;
            if (!copy(&byte, 1) || byte > 1) return fail();
            value = byte == 1;
        }
        else if constexpr (std::is_enum_v<T>)
        {
            std::underlying_type_t<T> number{};
            if (!copy(&number, sizeof number) ||
                number > static_cast<std::underlying_type_t<T>>(LastEnumerator<T>::value))
                return fail();
            value = static_cast<T>(number);
        }
        else
            copy(&value, sizeof value);
    }

    const uint8_t* _at;
    std::size_t _left;
    bool _good = true;
};

} // namespace osgRayTrace::engine
