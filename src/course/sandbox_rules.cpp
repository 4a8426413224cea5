#include "course/sandbox_rules.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <fcntl.h>
#include <initializer_list>
#include <linux/audit.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace etendue {

namespace {

constexpr std::uint64_t truncate_access = std::uint64_t{1} << 14;  // Of Landlock's third version.

constexpr std::uint64_t write_accesses = LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_REMOVE_DIR |
                                         LANDLOCK_ACCESS_FS_REMOVE_FILE | LANDLOCK_ACCESS_FS_MAKE_CHAR |
                                         LANDLOCK_ACCESS_FS_MAKE_DIR | LANDLOCK_ACCESS_FS_MAKE_REG |
                                         LANDLOCK_ACCESS_FS_MAKE_SOCK | LANDLOCK_ACCESS_FS_MAKE_FIFO |
                                         LANDLOCK_ACCESS_FS_MAKE_BLOCK | LANDLOCK_ACCESS_FS_MAKE_SYM;

/// Lets a Landlock ruleset allow these accesses below a path; what is not there needs no rule.
void allow(int ruleset, const char* path, std::uint64_t accesses) {
  const int folder = open(path, O_PATH | O_CLOEXEC);
  if (folder < 0) return;
  landlock_path_beneath_attr below{};
  below.allowed_access = accesses;
  below.parent_fd = folder;
  syscall(SYS_landlock_add_rule, ruleset, LANDLOCK_RULE_PATH_BENEATH, &below, 0);
  close(folder);
}

bool set_limit(__rlimit_resource resource, std::size_t most) {
  const rlimit limit{most, most};
  return setrlimit(resource, &limit) == 0;
}

constexpr std::uint32_t offset_of_call = offsetof(seccomp_data, nr);
constexpr std::uint32_t offset_of_architecture = offsetof(seccomp_data, arch);
constexpr std::uint32_t offset_of_first_argument = offsetof(seccomp_data, args);

constexpr sock_filter load(std::uint32_t offset) { return BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offset); }
constexpr sock_filter answer(std::uint32_t what) { return BPF_STMT(BPF_RET | BPF_K, what); }
constexpr sock_filter skip_unless(std::uint32_t value, std::uint8_t skipped) {
  return BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0, skipped);
}
constexpr sock_filter skip_unless_set(std::uint32_t bits, std::uint8_t skipped) {
  return BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, bits, 0, skipped);
}
constexpr std::uint32_t refused = SECCOMP_RET_ERRNO | EPERM;
constexpr std::uint32_t unknown_call = SECCOMP_RET_ERRNO | ENOSYS;

/// Rules for system calls, in order; of a fixed size, as it is made after a fork.
class CallFilter {
 public:
  void add(std::initializer_list<sock_filter> rules) {
    for (const sock_filter& rule : rules) rules_[count_++] = rule;
  }
  void refuse(long call) { add({skip_unless(std::uint32_t(call), 1), answer(refused)}); }
  /// The call of two instructions' test passes, else it fails. \param test skips one rule unless it passes
  void allow_only(long call, const sock_filter& test) {
    add({skip_unless(std::uint32_t(call), 4), load(offset_of_first_argument), test, answer(SECCOMP_RET_ALLOW),
         answer(refused)});
  }
  bool take_on() {
    add({answer(SECCOMP_RET_ALLOW)});
    const sock_fprog whole{count_, rules_.data()};
    return prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &whole) == 0;
  }

 private:
  std::array<sock_filter, 64> rules_{};
  unsigned short count_ = 0;
};

/// Calls that reach other processes or machines, or that make processes, fail. \param self the process
bool filter_calls(pid_t self, bool may_start_programs) {
  CallFilter filter;
  filter.add({load(offset_of_architecture), skip_unless(AUDIT_ARCH_X86_64, 1), BPF_STMT(BPF_JMP | BPF_JA, 1),
              answer(SECCOMP_RET_KILL_PROCESS), load(offset_of_call)});
  for (const long call : {SYS_socket, SYS_ptrace, SYS_process_vm_writev, SYS_io_uring_setup, SYS_tkill})
    filter.refuse(call);
  if (!may_start_programs) {
    // Folders that nobody may look into could be neither measured nor removed.
    constexpr int fchmodat2 = 452;
    for (const long call : {SYS_chmod, SYS_fchmod, SYS_fchmodat, fchmodat2}) filter.refuse(call);
    filter.refuse(SYS_fork);
    filter.refuse(SYS_vfork);
    // Threads are made by clone with a flag that can be seen; that of clone3 cannot, and libraries do
    // without.
    filter.add({skip_unless(SYS_clone3, 1), answer(unknown_call)});
    filter.allow_only(SYS_clone, skip_unless_set(CLONE_THREAD, 1));
    // A signal to itself is allowed: abort() is one.
    filter.allow_only(SYS_kill, skip_unless(std::uint32_t(self), 1));
    filter.allow_only(SYS_tgkill, skip_unless(std::uint32_t(self), 1));
  }
  return filter.take_on();
}

}  // namespace

SandboxRules::SandboxRules(const SandboxLimits& limits) : limits_(limits) { make_file_rules(limits); }

SandboxRules::~SandboxRules() {
  if (files_ >= 0) close(files_);
}

void SandboxRules::make_file_rules(const SandboxLimits& limits) {
  const long version = syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  landlock_ruleset_attr attributes{};
  attributes.handled_access_fs = write_accesses | (version >= 3 ? truncate_access : 0);
  if (version >= 1) files_ = int(syscall(SYS_landlock_create_ruleset, &attributes, sizeof attributes, 0));
  if (files_ < 0) {
    not_held_.emplace_back("it may write wherever you may: this kernel has no Landlock");
    return;
  }
  for (const std::filesystem::path& folder : limits.writable)
    allow(files_, folder.c_str(), attributes.handled_access_fs);
  allow(files_, "/dev/null", LANDLOCK_ACCESS_FS_WRITE_FILE);
}

bool SandboxRules::take_on() const {
  const auto processor_seconds = std::size_t(limits_.seconds) + 1;
  bool is_held = set_limit(RLIMIT_CORE, 0) && set_limit(RLIMIT_FSIZE, limits_.file_bytes) &&
                 set_limit(RLIMIT_CPU, processor_seconds * std::size_t(sysconf(_SC_NPROCESSORS_ONLN)));
  // Each open file may have been removed from its folder, and takes room that nobody sees.
  if (!limits_.may_start_programs) is_held = set_limit(RLIMIT_NOFILE, 64) && is_held;
  if (limits_.memory_bytes > 0) is_held = set_limit(RLIMIT_AS, limits_.memory_bytes) && is_held;
  is_held = prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && is_held;
  if (files_ >= 0) is_held = syscall(SYS_landlock_restrict_self, files_, 0) == 0 && is_held;
  return filter_calls(getpid(), limits_.may_start_programs) && is_held;
}

}  // namespace etendue
