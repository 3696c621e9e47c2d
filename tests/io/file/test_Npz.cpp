#include <random>

#include "io/file/Npz.h"
#include "support/IoFiles.h"
#include "support/NumpyFiles.h"

namespace polemcl::test_npz {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;

const std::string sixDoubles = doubles({1, 2, 3, 4, 5, 6});
const std::string cDictionary = dictionary("<f8", "False", "(3, 2)");
const std::string sample = npy(cDictionary, sixDoubles);

using Values = std::vector<double>;
using Shape = std::vector<std::size_t>;

class NpzTest : public FolderTest {
 protected:
  std::string openRefusal(const std::string& bytes) const {
    const fs::path file = write("a.npz", bytes);
    return messageOf([&] { NpzFile npz(file); });
  }
  std::string arrayRefusal(const std::string& bytes, const std::string& name = "a") const {
    const NpzFile npz(write("a.npz", bytes));
    return messageOf([&] { npz.array(name); });
  }
  /// Of an archive with this one array.
  std::string npyRefusal(const std::string& npy) const {
    return arrayRefusal(zip({{"a.npy", npy}}));
  }
  NumberArray parsed(const std::string& npy) const {
    return NpzFile(write("a.npz", zip({{"a.npy", npy}}))).array("a");
  }
};

TEST_F(NpzTest, ReadsArraysByHand) {
  const NumberArray array = parsed(sample);
  EXPECT_EQ(array.shape, (Shape{3, 2}));
  EXPECT_EQ(array.values, (Values{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(parsed(npy(dictionary("<f8", "False", "(6,)"), sixDoubles)).shape, (Shape{6}));
  EXPECT_EQ(parsed(npy(dictionary("<f8", "False", "()"), doubles({7}))).values, (Values{7}));
  EXPECT_EQ(parsed(npy(dictionary("<f8", "False", "(0, 2)"), "")).shape, (Shape{0, 2}));
}

TEST_F(NpzTest, RefusesWhatIsNoNpy) {
  expectIn(npyRefusal("PK abcdefgh"), path("a.npz").string() + ": array a: not .npy data");
  expectIn(npyRefusal(""), "array a: cut short");
  std::string later = sample;
  later[6] = 2;
  expectIn(npyRefusal(later), "version 1.0");
}

TEST_F(NpzTest, RefusesOtherLayouts) {
  for (const char* type : {"<f4", "<i8", ">f8", "|O", "<f80"})
    expectIn(npyRefusal(npy(dictionary(type, "False", "(3, 2)"), sixDoubles)), "numpy.savez(");
  expectIn(npyRefusal(npy(dictionary("<f8", "True", "(3, 2)"), sixDoubles)), "C order");
  expectIn(npyRefusal(npy("{'shape': (6,), }", sixDoubles)), "float64");
  for (const char* shape : {"(6", "(6;)", "(-6,)", "(,)", "(6.0,)", "(99999999999999999999,)"})
    expectIn(npyRefusal(npy(dictionary("<f8", "False", shape), sixDoubles)), "shape");
}

TEST_F(NpzTest, RefusesDataThatDoesNotFitTheShape) {
  for (const char* shape :
       {"(5,)", "(7,)", "(3, 3)", "(0,)", "(4294967296, 4294967296)", "(9223372036854775808, 2)",
        "(18446744073709551615, 18446744073709551615)"})
    expectIn(npyRefusal(npy(dictionary("<f8", "False", shape), sixDoubles)),
             "do not fit its shape");
  for (std::size_t size = 0; size < sample.size(); ++size)
    EXPECT_NE(npyRefusal(sample.substr(0, size)), "no error") << size;
}

TEST_F(NpzTest, ReadsSeveralArrays) {
  const NpzFile npz(write(
      "a.npz",
      zip({{"b.npy", npy(dictionary("<f8", "False", "(1,)"), doubles({9}))}, {"a.npy", sample}})));
  EXPECT_EQ(npz.names(), (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(npz.contains("a"));
  EXPECT_FALSE(npz.contains("c"));
  EXPECT_EQ(npz.array("a").values, (Values{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(npz.array("b").values, (Values{9}));
}

TEST_F(NpzTest, ReadsArchivesWithAComment) {
  EXPECT_TRUE(
      NpzFile(write("a.npz", zip({{"a.npy", sample}}, "PK\x05\x06 is no end"))).contains("a"));
}

TEST_F(NpzTest, ReadsAnEmptyArchive) {
  EXPECT_TRUE(NpzFile(write("a.npz", zip({}))).names().empty());
}

TEST_F(NpzTest, RefusesAMissingFile) {
  expectIn(messageOf([&] { NpzFile npz(path("no.npz")); }), path("no.npz").string(),
           "No such file or directory");
}

TEST_F(NpzTest, RefusesWhatIsNoZip) {
  expectIn(openRefusal("x,y\n1,2\n"), path("a.npz").string(), "not a .npz file");
  expectIn(openRefusal(std::string(100000, 'P')), "not a .npz file");
}

TEST_F(NpzTest, RefusesArchivesBeyond4GB) {
  const std::string bytes = zip({{"a.npy", sample}});
  for (const auto& [fromEnd, size] : {std::pair{12, 2}, std::pair{10, 4}, std::pair{6, 4}}) {
    std::string changed = bytes;
    changed.replace(bytes.size() - fromEnd, size, std::string(size, '\xff'));
    expectIn(openRefusal(changed), "4 GB");
  }
}

TEST_F(NpzTest, RefusesADirectoryThatIsNone) {
  std::string bytes = zip({{"a.npy", sample}});
  bytes[bytes.find("PK\x01\x02")] = 'X';
  expectIn(openRefusal(bytes), "entry 0");
}

TEST_F(NpzTest, RefusesADirectoryBeyondTheEnd) {
  std::string bytes = zip({{"a.npy", sample}});
  bytes.replace(bytes.size() - 6, 4, little(bytes.size(), 4));
  expectIn(openRefusal(bytes), "beyond its end");
}

TEST_F(NpzTest, RefusesADirectoryLongerThanItsEntries) {
  std::string bytes = zip({{"a.npy", sample}, {"b.npy", sample}});
  bytes.replace(bytes.size() - 12, 2, little(1, 2));
  expectIn(openRefusal(bytes), "longer than its entries");
}

TEST_F(NpzTest, RefusesAnArrayThatIsNotThere) {
  expectIn(arrayRefusal(zip({{"a.npy", sample}}), "b"), path("a.npz").string(), "no array b");
}

TEST_F(NpzTest, RefusesCompressedArrays) {
  std::string bytes = zip({{"a.npy", sample}});
  bytes[bytes.find("PK\x01\x02") + 10] = 8;  // deflated
  expectIn(arrayRefusal(bytes), "compressed", "numpy.savez");
}

TEST_F(NpzTest, RefusesAWrongChecksum) {
  std::string bytes = zip({{"a.npy", sample}});
  bytes[bytes.find("PK\x01\x02") - 1] ^= 1;  // the last byte of the data
  expectIn(arrayRefusal(bytes), "array a", "CRC-32");
}

TEST_F(NpzTest, RefusesALocalHeaderThatIsNone) {
  std::string bytes = zip({{"a.npy", sample}});
  bytes[0] = 'X';
  expectIn(arrayRefusal(bytes), "header");
}

TEST_F(NpzTest, RefusesEveryPrefixOfAFile) {
  const std::string bytes = zip({{"a.npy", sample}});
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const fs::path file = write("a.npz", bytes.substr(0, size));
    EXPECT_THROW(NpzFile(file).array("a"), Error) << size;
  }
}

TEST_F(NpzTest, AFlippedBitIsRefusedOrOfNoConsequence) {
  // Dates, versions and unused sizes of a zip archive have no checksum and are not read. Any other
  // flip must be rejected; other values must never be returned.
  const std::string bytes = zip({{"a.npy", sample}});
  std::size_t refused = 0;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::string damaged = bytes;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << bit % 8));
    const fs::path file = write("a.npz", damaged);
    try {
      EXPECT_EQ(NpzFile(file).array("a").values, (Values{1, 2, 3, 4, 5, 6})) << bit;
    } catch (const Error&) {
      ++refused;
    }
  }
  // At least all bits of the data itself and of the records' signatures.
  EXPECT_GE(refused, 8 * (sample.size() + 12));
}

TEST_F(NpzTest, ManyFlippedBytesNeverCrash) {
  const std::string bytes = zip({{"a.npy", sample}, {"b.npy", sample}});
  std::mt19937_64 generator(9);
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string damaged = bytes;
    for (int k = 0; k < 1 + i % 8; ++k) {
      damaged[generator() % damaged.size()] = static_cast<char>(generator());
    }
    const fs::path file = write("a.npz", damaged);
    try {
      const NpzFile npz(file);
      for (const std::string& name : npz.names()) npz.array(name);
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace polemcl::test_npz
