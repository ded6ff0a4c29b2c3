#include <support/scratch_folder.hpp>

#include <sloper/base/error.hpp>
#include <sloper/io/files.hpp>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>

using namespace sloper;
using namespace sloper::test;

static ErrorKind kind_of(const std::function<void()>& deed, std::string* message = nullptr) {
  try {
    deed();
  } catch (const Error& e) {
    if (message)
      *message = e.what();
    return e.kind();
  }
  ADD_FAILURE() << "nothing was thrown";
  return ErrorKind::INTERNAL;
}

TEST(Files, come_back_byte_for_byte) {
  const ScratchFolder folder;
  const std::string bytes("a\0b\r\n\xff", 6);
  io::write_file(folder / "x", bytes);
  EXPECT_EQ(io::read_file(folder / "x"), bytes);
  io::write_file(folder / "x", "");
  EXPECT_EQ(io::read_file(folder / "x"), "");
  EXPECT_EQ(folder.n_files(), 1u);
}

TEST(Files, a_missing_one_and_a_folder_are_bad_input_that_names_the_path) {
  const ScratchFolder folder;
  std::string message;
  EXPECT_EQ(kind_of([&] { io::read_file(folder / "none.json"); }, &message), ErrorKind::INPUT);
  EXPECT_FALSE(io::read_file_if_there(folder / "none.json"));
  EXPECT_EQ(kind_of([&] { io::read_file_if_there(folder.path()); }), ErrorKind::INPUT);
  EXPECT_NE(message.find("none.json"), std::string::npos);
  EXPECT_EQ(kind_of([&] { io::read_file(folder.path()); }, &message), ErrorKind::INPUT);
  EXPECT_NE(message.find("folder"), std::string::npos);
}

TEST(Files, that_cannot_be_written_are_an_output_error) {
  const ScratchFolder folder;
  EXPECT_EQ(kind_of([&] { io::write_file(folder / "no/such/x", "1"); }), ErrorKind::OUTPUT);
  EXPECT_EQ(kind_of([&] { io::write_file(folder.path(), "1"); }), ErrorKind::OUTPUT);
  EXPECT_EQ(kind_of([&] { io::write_file("/dev/full", "1"); }), ErrorKind::OUTPUT);
  EXPECT_EQ(folder.n_files(), 0u);
}

TEST(Files, a_write_that_fails_half_way_leaves_the_old_file_and_nothing_else) {
  const ScratchFolder folder;
  io::write_file(folder / "x", "old");
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before); // the way to make a disk full at will
  const rlimit tight{1000, before.rlim_max};
  std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &tight);
  const ErrorKind kind = kind_of([&] { io::write_file(folder / "x", std::string(100000, 'n')); });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, SIG_DFL);
  EXPECT_EQ(kind, ErrorKind::OUTPUT);
  EXPECT_EQ(io::read_file(folder / "x"), "old");
  EXPECT_EQ(folder.n_files(), 1u);
}

TEST(Files, a_link_stays_a_link) {
  const ScratchFolder folder;
  io::write_file(folder / "x", "old");
  std::filesystem::create_symlink("x", folder / "link");
  io::write_file(folder / "link", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(io::read_file(folder / "x"), "new");
}

TEST(Files, a_device_is_written_and_not_replaced) {
  io::write_file("/dev/null", "gone");
  struct stat info {};
  ASSERT_EQ(stat("/dev/null", &info), 0);
  EXPECT_TRUE(S_ISCHR(info.st_mode));
}

TEST(Sha256, gives_the_published_vectors) {
  EXPECT_EQ(io::sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(io::sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(io::sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(io::sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}
