// RunningProgram.h - a program on a terminal of its own, which gets signals while it works.
// SPDX-License-Identifier: MIT
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

class RunningProgram
{
public:
    /// Starts the program in the folder; prints() can wait for its output. environment is
    /// "NAME=value".
    RunningProgram(const std::string& folder, std::vector<std::string> arguments,
                   const std::vector<std::string>& environment = {})
    {
        _process = forkpty(&_terminal, nullptr, nullptr, nullptr);
        if (_process != 0) return;
        std::vector<char*> pointers;
        for (std::string& argument : arguments)
            pointers.push_back(argument.data());
        pointers.push_back(nullptr);
        for (const std::string& variable : environment)
            putenv(strdup(variable.c_str()));
        if (chdir(folder.c_str()) == 0) execv(pointers[0], pointers.data());
        _exit(127);
    }
    ~RunningProgram()
    {
        if (!_ended) kill(_process, SIGKILL);
        wait();
        close(_terminal);
    }
    RunningProgram(const RunningProgram&) = delete;
    RunningProgram& operator=(const RunningProgram&) = delete;

    /// Returns false if the program does not print the text within a minute or before it ends.
    bool prints(const std::string& text)
    {
        const auto isThere = [&] { return _printed.find(text) != std::string::npos; };
        while (!isThere() && readSome())
        {
        }
        return isThere();
    }

    void signal(int number) { kill(_process, number); }

    /// Returns the exit code, or minus the signal that ended the program.
    int wait()
    {
        while (readSome())
        {
        }
        if (_ended) return _code;
        int status = 0;
        waitpid(_process, &status, 0);
        _ended = true;
        _code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
        return _code;
    }

    const std::string& printed() const { return _printed; }

private:
    bool readSome()
    {
        pollfd events{_terminal, POLLIN, 0};
        char buffer[4096];
        if (poll(&events, 1, 60000) != 1) return false;
        const ssize_t count = read(_terminal, buffer, sizeof(buffer));
        if (count <= 0) return false;
        _printed.append(buffer, static_cast<std::size_t>(count));
        return true;
    }

    int _terminal = -1;
    pid_t _process = -1;
    bool _ended = false;
    int _code = 0;
    std::string _printed;
};
