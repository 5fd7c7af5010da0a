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
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

class RunningProgram
{
public:
    /// Starts the program in the folder; prints() can wait for its output. environment is
    /// "NAME=value".
    RunningProgram(const std::string& folder, std::vector<std::string> arguments,
                   const std::vector<std::string>& environment = {})
    {
        _file = std::filesystem::canonical(arguments[0]);
        _process = forkpty(&_terminal, nullptr, nullptr, nullptr);
        // Signals to process -1 would go to all processes.
        if (_process < 0) throw std::runtime_error("there is no terminal");
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

    /// Returns false if the program does not handle the signal within a minute.
    bool handles(int number) const
    {
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
        while (!handlesNow(number) && std::chrono::steady_clock::now() < end)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return handlesNow(number);
    }

    void signal(int number) { kill(_process, number); }
    pid_t process() const { return _process; }

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
    bool handlesNow(int number) const
    {
        // Until it becomes the program, the child process has the handlers of its parent.
        const std::string process = "/proc/" + std::to_string(_process);
        std::error_code error;
        if (std::filesystem::read_symlink(process + "/exe", error) != _file) return false;
        std::ifstream status(process + "/status");
        std::string word;
        while (status >> word)
            if (word == "SigCgt:") break;
        std::uint64_t handled = 0;
        status >> std::hex >> handled;
        return (handled >> (number - 1) & 1) != 0;
    }

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

    std::filesystem::path _file;
    int _terminal = -1;
    pid_t _process = -1;
    bool _ended = false;
    int _code = 0;
    std::string _printed;
};
