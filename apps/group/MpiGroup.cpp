// MpiGroup.cpp - messages and sums by MPI 3, as Open MPI and MPICH have it. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/group/MpiGroup.h"

// The C interface is enough, and C++ bindings of MPI are gone from its standard.
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <list>
#include <thread>

namespace osgRayTrace::app
{

namespace
{

constexpr int kTag = 1;
constexpr std::size_t kSumValues = std::size_t(1) << 23; ///< values that are added up at a time
constexpr std::size_t kBroadcastBytes = std::size_t(1) << 24; ///< bytes that are sent at a time

/// One thread calls MPI, which never waits: a call that waits would spin on a core that renders.
class MpiGroup : public Group
{
public:
    MpiGroup()
    {
        int provided = 0;
        MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
        MPI_Comm_rank(MPI_COMM_WORLD, &_rank);
        MPI_Comm_size(MPI_COMM_WORLD, &_size);
        MPI_Comm machine;
        MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, _rank, MPI_INFO_NULL, &machine);
        MPI_Comm_size(machine, &_localSize);
        MPI_Comm_free(&machine);
    }

    ~MpiGroup() override
    {
        for (Sent& sent : _sent)
            MPI_Wait(&sent.request, MPI_STATUS_IGNORE);
        MPI_Finalize();
    }

    int rank() const override { return _rank; }
    int size() const override { return _size; }
    int localSize() const override { return _localSize; }

    void send(int rank, const GroupMessage& message) override
    {
        _sent.push_back({packed(message), MPI_REQUEST_NULL});
        Sent& sent = _sent.back();
        MPI_Isend(sent.bytes.data(), static_cast<int>(sent.bytes.size()), MPI_BYTE, rank, kTag,
                  MPI_COMM_WORLD, &sent.request);
    }

    std::optional<std::pair<int, GroupMessage>> receive() override
    {
        _sent.remove_if(
            [](Sent& sent)
            {
                int isDone = 0;
                MPI_Test(&sent.request, &isDone, MPI_STATUS_IGNORE);
                return isDone != 0;
            });
        int isThere = 0;
        MPI_Status status;
        MPI_Iprobe(MPI_ANY_SOURCE, kTag, MPI_COMM_WORLD, &isThere, &status);
        if (!isThere) return std::nullopt;
        int size = 0;
        MPI_Get_count(&status, MPI_BYTE, &size);
        std::vector<char> bytes(static_cast<std::size_t>(size));
        MPI_Recv(bytes.data(), size, MPI_BYTE, status.MPI_SOURCE, kTag, MPI_COMM_WORLD,
                 MPI_STATUS_IGNORE);
        std::optional<GroupMessage> message = unpacked(bytes);
        if (!message) abort(3); // another program speaks
        return std::pair(status.MPI_SOURCE, std::move(*message));
    }

    void beginSum(std::int64_t* values, std::size_t count) override
    {
        _values = values;
        _valuesLeft = count;
        sumNext();
    }

    bool sumIsDone() override
    {
        int isDone = 0;
        MPI_Test(&_sum, &isDone, MPI_STATUS_IGNORE);
        if (!isDone) return false;
        if (_valuesLeft == 0) return true;
        sumNext();
        return false;
    }

    void beginBroadcast(unsigned char* bytes, std::size_t count) override
    {
        _bytes = bytes;
        _bytesLeft = count;
        broadcastNext();
    }

    bool broadcastIsDone() override
    {
        int isDone = 0;
        MPI_Test(&_broadcast, &isDone, MPI_STATUS_IGNORE);
        if (!isDone) return false;
        if (_bytesLeft == 0) return true;
        broadcastNext();
        return false;
    }

    [[noreturn]] void abort(int code) override
    {
        // Open MPI waits for its launcher, which may be busy with ending the job itself.
        std::thread(
            [code]
            {
                std::this_thread::sleep_for(std::chrono::milliseconds(100));
                std::_Exit(code);
            })
            .detach();
        MPI_Abort(MPI_COMM_WORLD, code);
        std::_Exit(code);
    }

private:
    struct Sent
    {
        std::vector<char> bytes;
        MPI_Request request;
    };

    /// Begins with the next values: counts of MPI are int.
    void sumNext()
    {
        const std::size_t count = std::min(_valuesLeft, kSumValues);
        const bool isRoot = _rank == 0;
        MPI_Ireduce(isRoot ? MPI_IN_PLACE : _values, isRoot ? _values : nullptr,
                    static_cast<int>(count), MPI_INT64_T, MPI_SUM, 0, MPI_COMM_WORLD, &_sum);
        _values += count;
        _valuesLeft -= count;
    }

    void broadcastNext()
    {
        const std::size_t count = std::min(_bytesLeft, kBroadcastBytes);
        MPI_Ibcast(_bytes, static_cast<int>(count), MPI_BYTE, 0, MPI_COMM_WORLD, &_broadcast);
        _bytes += count;
        _bytesLeft -= count;
    }

    int _rank = 0;
    int _size = 1;
    int _localSize = 1;
    std::list<Sent> _sent; ///< messages on their way
    MPI_Request _sum = MPI_REQUEST_NULL;
    std::int64_t* _values = nullptr;
    std::size_t _valuesLeft = 0;
    MPI_Request _broadcast = MPI_REQUEST_NULL;
    unsigned char* _bytes = nullptr;
    std::size_t _bytesLeft = 0;
};

} // namespace

std::unique_ptr<Group> mpiGroup()
{
    return std::make_unique<MpiGroup>();
}

std::string mpiName()
{
    char name[MPI_MAX_LIBRARY_VERSION_STRING] = "";
    int length = 0;
    MPI_Get_library_version(name, &length);
    std::string text(name, static_cast<std::size_t>(length));
    text = text.substr(0, text.find_first_of(",\n"));
    std::replace(text.begin(), text.end(), '\t', ' ');
    return text;
}

} // namespace osgRayTrace::app
