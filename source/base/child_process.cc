// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/atomic_file.h>
#include <debond/base/child_process.h>
#include <debond/base/interrupt.h>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    /// What a shell returns as well if there is no such program.
    constexpr int no_program = 127;



    /// In the child: it reads nothing, writes to the log and ends with its
    /// parent. Only calls that are safe between fork() and exec().
    bool
    set_up_child(const int log)
    {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      const int nothing = open("/dev/null", O_RDONLY);
      return dup2(nothing, STDIN_FILENO) >= 0 &&
             dup2(log, STDOUT_FILENO) >= 0 && dup2(log, STDERR_FILENO) >= 0;
    }



    /// In the child, as above.
    [[noreturn]] void
    become(char *const argv[], const int log, const char *const directory)
    {
      if (set_up_child(log) && chdir(directory) == 0)
        execvp(argv[0], argv);
      _exit(no_program);
    }



    /// Signals that come while an object of this class exists wait for its end.
    class SignalBlock
    {
    public:
      SignalBlock()
      {
        sigset_t signals;
        sigemptyset(&signals);
        sigaddset(&signals, SIGINT);
        sigaddset(&signals, SIGTERM);
        pthread_sigmask(SIG_BLOCK, &signals, &previous);
      }

      ~SignalBlock()
      {
        pthread_sigmask(SIG_SETMASK, &previous, nullptr);
      }

    private:
      sigset_t previous;
    };
  } // namespace



  ChildProcess::ChildProcess(const std::vector<std::string> &command,
                             const std::string              &log_file,
                             const std::string              &working_directory)
  {
    setenv("OPENBLAS_NUM_THREADS", "1", 1);
    setenv("OMP_NUM_THREADS", "1", 1);
    std::vector<std::string> words = command;
    std::vector<char *>      argv;
    for (std::string &word : words)
      argv.push_back(word.data());
    argv.push_back(nullptr);
    const std::string directory =
      working_directory.empty() ? "." : working_directory;

    const int log = create_file(log_file);
    process       = fork();
    if (process == 0)
      become(argv.data(), log, directory.c_str());
    const int error = errno;
    close(log);
    if (process < 0)
      throw std::runtime_error("Cannot start " + command.front() + ": " +
                               std::strerror(error));
  }



  ChildProcess::ChildProcess(const std::function<int()> &work,
                             const std::string          &log_file)
  {
    const int log = create_file(log_file);
    // What is not written yet would be written twice.
    std::cout.flush();
    std::cerr.flush();
    std::optional<SignalBlock> block(std::in_place);
    process = fork();
    if (process == 0)
      {
        // A signal to the child is not for what this process does with them.
        InterruptGuard::leave_to_parent();
        block.reset();
        const int code = set_up_child(log) ? work() : no_program;
        std::cout.flush();
        std::cerr.flush();
        // This process's objects are not the child's to destroy.
        _exit(code);
      }
    const int error = errno;
    close(log);
    if (process < 0)
      throw std::runtime_error(std::string("Cannot start a process: ") +
                               std::strerror(error));
  }



  ChildProcess::~ChildProcess()
  {
    if (!ending)
      {
        send_signal(SIGKILL);
        wait();
      }
  }



  const std::optional<std::string> &
  ChildProcess::poll()
  {
    int status = 0;
    if (!ending && waitpid(process, &status, WNOHANG) == process)
      record(status);
    return ending;
  }



  const std::string &
  ChildProcess::wait()
  {
    int status = 0;
    while (!ending)
      if (waitpid(process, &status, 0) == process)
        record(status);
      else if (errno != EINTR)
        ending = "lost";
    return *ending;
  }



  void
  ChildProcess::send_signal(const int number) const
  {
    if (!ending)
      kill(process, number);
  }



  void
  ChildProcess::record(const int wait_status)
  {
    if (WIFSIGNALED(wait_status))
      ending = "killed by signal " + std::to_string(WTERMSIG(wait_status)) +
               " (" + strsignal(WTERMSIG(wait_status)) + ")";
    else if (WEXITSTATUS(wait_status) == 0)
      ending = "";
    else
      ending = "exit code " + std::to_string(WEXITSTATUS(wait_status));
  }
} // namespace Debond
