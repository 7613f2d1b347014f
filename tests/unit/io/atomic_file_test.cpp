// Proves that AtomicFile shows its target complete or not at all after any failure, and which kinds of target it
// accepts.
#include "blum/io/atomic_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <string>
#include <thread>

#include "blum/core/error.hpp"
#include "temporary_folder.hpp"

namespace blum {
namespace {

namespace fs = std::filesystem;
using test::file_content;
using test::put_file;
using test::TemporaryFolder;

void write_file(const fs::path& path, std::string_view content) {
  AtomicFile file(path);
  file.write(content);
  file.commit();
}

/// The message of the FileError that the call throws; empty if the call throws none.
template <class Call>
std::string error_of(Call call) {
  try {
    call();
  } catch (const FileError& error) {
    return error.what();
  }
  return {};
}

TEST(AtomicFile, AppearsOnlyOnCommit) {
  const TemporaryFolder folder;
  AtomicFile file(folder / "new.bin");
  file.write("content");
  EXPECT_FALSE(fs::exists(folder / "new.bin"));
  EXPECT_EQ(file.size(), 7U);
  file.commit();
  EXPECT_EQ(file_content(folder / "new.bin"), "content");
  EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicFile, WithoutCommitOnlyTheOldFileStays) {
  const TemporaryFolder folder;
  put_file(folder / "a", "old");
  {
    AtomicFile file(folder / "a");
    file.write("new");
    EXPECT_EQ(folder.entries(), 2);
  }
  EXPECT_EQ(file_content(folder / "a"), "old");
  EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicFile, WritesOfAnySizeArriveInOrder) {
  const TemporaryFolder folder;
  std::string expected;
  {
    AtomicFile file(folder / "a");
    for (const std::size_t size : {1U, 300000U, 0U, 262143U, 2U, 262144U, 5U, 1000000U, 17U}) {
      const std::string piece(size, static_cast<char>('a' + expected.size() % 26));
      file.write(piece);
      expected += piece;
    }
    file.commit();
  }
  EXPECT_TRUE(file_content(folder / "a") == expected);
}

TEST(AtomicFile, EmptyFile) {
  const TemporaryFolder folder;
  write_file(folder / "empty", "");
  EXPECT_TRUE(fs::exists(folder / "empty"));
  EXPECT_EQ(fs::file_size(folder / "empty"), 0U);
}

TEST(AtomicFile, KeepsPermissionsOfTheOldFileAndTakesTheUmaskForNewOnes) {
  const TemporaryFolder folder;
  put_file(folder / "old", "old");
  fs::permissions(folder / "old", static_cast<fs::perms>(0640));
  write_file(folder / "old", "new");
  EXPECT_EQ(fs::status(folder / "old").permissions(), static_cast<fs::perms>(0640));
  const mode_t mask = ::umask(027);
  write_file(folder / "new", "new");
  ::umask(mask);
  EXPECT_EQ(fs::status(folder / "new").permissions(), static_cast<fs::perms>(0640));
}

TEST(AtomicFile, FollowsLinksAndKeepsThem) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "sub");
  put_file(folder / "sub/target", "old");
  fs::create_symlink("sub/target", folder / "link");
  fs::create_symlink("link", folder / "link2");
  fs::create_symlink("sub/fresh", folder / "dangling");
  write_file(folder / "link2", "new");
  write_file(folder / "dangling", "fresh");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_TRUE(fs::is_symlink(folder / "link2"));
  EXPECT_TRUE(fs::is_symlink(folder / "dangling"));
  EXPECT_EQ(file_content(folder / "sub/target"), "new");
  EXPECT_EQ(file_content(folder / "sub/fresh"), "fresh");
}

TEST(AtomicFile, TargetsThatCannotBeWrittenAreRefusedWithTheReason) {
  const TemporaryFolder folder;
  fs::create_symlink("circle", folder / "circle");
  const auto open = [](const fs::path& path) { return error_of([&] { const AtomicFile file(path); }); };
  EXPECT_NE(open(folder.path()).find("Is a directory"), std::string::npos);
  EXPECT_NE(open(folder / "new/").find("Is a directory"), std::string::npos);
  EXPECT_NE(open(folder / "missing/file").find("No such file or directory"), std::string::npos);
  EXPECT_NE(open(folder / "missing/file").find("missing/file'"), std::string::npos);
  EXPECT_NE(open(folder / "circle").find("symbolic links"), std::string::npos);
  EXPECT_NE(open(folder / std::string(300, 'a')).find("File name too long"), std::string::npos);
  EXPECT_NE(open("").find("without a name"), std::string::npos);
  EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicFile, LongNamesLeaveRoomForTheTemporary) {
  const TemporaryFolder folder;
  write_file(folder / std::string(255, 'a'), "x");
  EXPECT_EQ(file_content(folder / std::string(255, 'a')), "x");
}

TEST(AtomicFile, NameWithoutFolder) {
  const TemporaryFolder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  write_file("plain", "x");
  fs::current_path(before);
  EXPECT_EQ(file_content(folder / "plain"), "x");
}

TEST(AtomicFile, ReadOnlyFileIsRefused) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everything";
  const TemporaryFolder folder;
  put_file(folder / "a", "old");
  fs::permissions(folder / "a", static_cast<fs::perms>(0444));
  EXPECT_NE(error_of([&] { const AtomicFile file(folder / "a"); }).find("Permission denied"), std::string::npos);
}

TEST(AtomicFile, DevicesAreWrittenDirectly) {
  write_file("/dev/null", "x");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  const std::string message = error_of([] { write_file("/dev/full", "x"); });
  EXPECT_NE(message.find("No space left on device"), std::string::npos) << message;
  const std::string large = error_of([] { write_file("/dev/full", std::string(1000000, 'x')); });
  EXPECT_NE(large.find("No space left on device"), std::string::npos) << large;
}

TEST(AtomicFile, PipesAreWrittenDirectly) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  std::string received;
  std::jthread reader([&] { received = file_content(folder / "pipe"); });
  write_file(folder / "pipe", std::string(500000, 'x'));
  reader.join();
  EXPECT_TRUE(received == std::string(500000, 'x'));
  EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
}

TEST(AtomicFile, OpenDescriptorsByName) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  write_file("/dev/fd/" + std::to_string(ends[1]), "hello");
  std::array<char, 8> received{};
  EXPECT_EQ(::read(ends[0], received.data(), received.size()), 5);
  EXPECT_STREQ(received.data(), "hello");
  ::close(ends[0]);
  ::close(ends[1]);
  EXPECT_NE(error_of([] { const AtomicFile file("/dev/fd/987"); }).find("Bad file descriptor"), std::string::npos);
}

TEST(AtomicFile, FullDiskKeepsTheOldFile) {
  // A limit on the size of files imitates the full disk: writes fail half-way in the same manner.
  const TemporaryFolder folder;
  put_file(folder / "a", "old");
  rlimit limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &limit), 0);
  rlimit small = limit;
  small.rlim_cur = 100000;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string message = error_of([&] { write_file(folder / "a", std::string(1000000, 'x')); });
  const std::string at_commit = error_of([&] { write_file(folder / "a", std::string(200000, 'x')); });
  ::setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(message.find("File too large"), std::string::npos) << message;
  EXPECT_NE(at_commit.find("File too large"), std::string::npos) << at_commit;
  EXPECT_EQ(file_content(folder / "a"), "old");
  EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicFile, LeavesNothingIfTheTargetBecameAFolder) {
  const TemporaryFolder folder;
  AtomicFile file(folder / "a");
  file.write("x");
  fs::create_directory(folder / "a");
  EXPECT_NE(error_of([&] { file.commit(); }).find("cannot replace"), std::string::npos);
  EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicFile, NothingCanBeWrittenAfterCommit) {
  const TemporaryFolder folder;
  AtomicFile file(folder / "a");
  file.commit();
  EXPECT_THROW(file.write("x"), FileError);
  EXPECT_THROW(file.commit(), FileError);
}

}  // namespace
}  // namespace blum
