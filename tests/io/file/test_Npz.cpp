#include <random>

#include "io/file/Npz.h"
#include "support/IoFiles.h"
#include "support/NumpyFiles.h"

namespace polemcl::test_npz {

using namespace polemcl;
using namespace polemcl::io;
using namespace polemcl::io::test;

namespace {

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
};

std::string npyRefusal(const std::string& bytes) {
  return messageOf([&] { parseNpy(bytes, "f: "); });
}

}  // namespace

TEST(Npy, ReadsCOrderByHand) {
  const NumberArray array = parseNpy(sample, "");
  EXPECT_EQ(array.shape, (Shape{3, 2}));
  EXPECT_EQ(array.values, (Values{1, 2, 3, 4, 5, 6}));
}

TEST(Npy, ReadsFortranOrderByHand) {
  // Columns one after the other: (1 2 3) and (4 5 6).
  const NumberArray array = parseNpy(npy(dictionary("<f8", "True", "(3, 2)"), sixDoubles), "");
  EXPECT_EQ(array.values, (Values{1, 4, 2, 5, 3, 6}));
  // First index fastest: element (i, j, k) is number i + 2j + 2k of shape (2, 1, 3).
  const NumberArray cube = parseNpy(npy(dictionary("<f8", "True", "(2, 1, 3)"), sixDoubles), "");
  EXPECT_EQ(cube.values, (Values{1, 3, 5, 2, 4, 6}));
}

TEST(Npy, ReadsFloat32AndVersions) {
  const std::string data = floats({0.5f, -1, 2, 1e10f});
  for (const int version : {1, 2, 3}) {
    const NumberArray array =
        parseNpy(npy(dictionary("<f4", "False", "(2, 2)"), data, version), "");
    EXPECT_EQ(array.values, (Values{0.5, -1, 2, 1e10f}));
  }
}

TEST(Npy, ReadsOtherShapes) {
  EXPECT_EQ(parseNpy(npy(dictionary("<f8", "False", "(6,)"), sixDoubles), "").shape, (Shape{6}));
  EXPECT_EQ(parseNpy(npy(dictionary("<f8", "False", "()"), doubles({7})), "").values, (Values{7}));
  EXPECT_EQ(parseNpy(npy(dictionary("<f8", "False", "(0, 2)"), ""), "").shape, (Shape{0, 2}));
}

TEST(Npy, RefusesWhatIsNoNpy) {
  expectIn(npyRefusal("PK abcdefgh"), "f: ", "not .npy data");
  expectIn(npyRefusal(""), "not .npy data");
}

TEST(Npy, RefusesOtherVersions) {
  expectIn(npyRefusal(npy(cDictionary, sixDoubles, 4)), "version 4");
}

TEST(Npy, RefusesOtherTypes) {
  for (const char* type : {"<i8", ">f8", "<f2", "|O", "<f80", "<U4"}) {
    expectIn(npyRefusal(npy(dictionary(type, "False", "(3, 2)"), sixDoubles)), type, "'<f8'");
  }
}

TEST(Npy, RefusesMalformedHeaders) {
  expectIn(npyRefusal(npy("{'fortran_order': False, 'shape': (6,), }", sixDoubles)), "no descr");
  expectIn(npyRefusal(npy("{'descr': '<f8', 'shape': (6,), }", sixDoubles)), "no fortran_order");
  expectIn(npyRefusal(npy("{'descr': '<f8', 'fortran_order': False}", sixDoubles)), "no shape");
  expectIn(npyRefusal(npy(dictionary("<f8", "Maybe", "(6,)"), sixDoubles)), "fortran_order");
  for (const char* shape :
       {"6", "(6", "(6;)", "(-6,)", "(,)", "(6.0,)", "(99999999999999999999,)"}) {
    expectIn(npyRefusal(npy(dictionary("<f8", "False", shape), sixDoubles)), "shape");
  }
}

TEST(Npy, RefusesDataThatDoesNotFitTheShape) {
  for (const char* shape :
       {"(5,)", "(7,)", "(3, 3)", "(0,)", "(4294967296, 4294967296)", "(9223372036854775808, 2)",
        "(18446744073709551615, 18446744073709551615)"}) {
    expectIn(npyRefusal(npy(dictionary("<f8", "False", shape), sixDoubles)),
             "do not fit its shape");
  }
}

TEST(Npy, RefusesEveryPrefix) {
  for (std::size_t size = 0; size < sample.size(); ++size) {
    EXPECT_THROW(parseNpy(std::string_view(sample).substr(0, size), ""), Error) << size;
  }
}

TEST_F(NpzTest, ReadsStoredAndDeflatedMembers) {
  const NpzFile npz(
      write("a.npz", zip({{"b.npy", npy(dictionary("<f8", "False", "(1,)"), doubles({9}))},
                          {"a.npy", sample, true}})));
  EXPECT_EQ(npz.names(), (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(npz.contains("a"));
  EXPECT_FALSE(npz.contains("c"));
  EXPECT_EQ(npz.array("a").values, (Values{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(npz.array("b").values, (Values{9}));
}

TEST_F(NpzTest, ReadsLargeDeflatedMembers) {
  // Very compressible, near the greatest ratio of deflate.
  const std::string zeros(8000000, '\0');
  const NpzFile npz(
      write("a.npz", zip({{"a.npy", npy(dictionary("<f8", "False", "(1000000,)"), zeros), true}})));
  EXPECT_EQ(npz.array("a").values, Values(1000000, 0.0));
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

TEST_F(NpzTest, RefusesEncryptedMembers) {
  std::string bytes = zip({{"a.npy", sample}});
  bytes[bytes.find("PK\x01\x02") + 8] = 1;
  expectIn(arrayRefusal(bytes), "encrypted");
}

TEST_F(NpzTest, RefusesOtherCompression) {
  std::string bytes = zip({{"a.npy", sample}});
  bytes[bytes.find("PK\x01\x02") + 10] = 14;  // LZMA
  expectIn(arrayRefusal(bytes), "method 14");
}

TEST_F(NpzTest, RefusesAWrongChecksum) {
  std::string bytes = zip({{"a.npy", sample}});
  bytes[bytes.find("PK\x01\x02") - 1] ^= 1;  // the last byte of the data
  expectIn(arrayRefusal(bytes), "array a", "CRC-32");
}

TEST_F(NpzTest, RefusesDeflateDataThatIsDamaged) {
  std::string bytes = zip({{"a.npy", sample, true}});
  const std::size_t data = 30 + 5 + 20;
  bytes[data] = '\x07';  // a block of the reserved kind
  expectIn(arrayRefusal(bytes), "decompressed");
}

TEST_F(NpzTest, RefusesClaimsThatNoDataCanFulfil) {
  std::string bytes = zip({{"a.npy", sample, true}});
  bytes.replace(bytes.find("PK\x01\x02") + 24, 4, little(0xfffffff0, 4));
  expectIn(arrayRefusal(bytes), "cannot hold 4294967280");
}

TEST_F(NpzTest, RefusesAStoredMemberOfTwoSizes) {
  std::string bytes = zip({{"a.npy", sample}});
  bytes.replace(bytes.find("PK\x01\x02") + 24, 4, little(sample.size() - 1, 4));
  expectIn(arrayRefusal(bytes), "two different sizes");
}

TEST_F(NpzTest, RefusesALocalHeaderThatIsNone) {
  std::string bytes = zip({{"a.npy", sample}});
  bytes[0] = 'X';
  expectIn(arrayRefusal(bytes), "header");
}

TEST_F(NpzTest, RefusesEveryPrefixOfAFile) {
  for (const bool deflate : {false, true}) {
    const std::string bytes = zip({{"a.npy", sample, deflate}});
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const fs::path file = write("a.npz", bytes.substr(0, size));
      EXPECT_THROW(NpzFile(file).array("a"), Error) << size;
    }
  }
}

TEST_F(NpzTest, AFlippedBitIsRefusedOrOfNoConsequence) {
  // Dates, versions and unused sizes of a zip archive have no checksum and are not read. Any other
  // flip must be rejected; other values must never be returned.
  for (const bool deflate : {false, true}) {
    const std::string bytes = zip({{"a.npy", sample, deflate}});
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
    EXPECT_GE(refused, 8 * ((deflate ? deflated(sample) : sample).size() + 12));
  }
}

TEST_F(NpzTest, ManyFlippedBytesNeverCrash) {
  const std::string bytes = zip({{"a.npy", sample, true}, {"b.npy", sample}});
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

TEST(Npy, WritesWhatItsDocumentSays) {
  EXPECT_EQ(npyBytes({{3, 2}, {1, 2, 3, 4, 5, 6}}), sample);
  EXPECT_EQ(npyBytes({{2}, {1, 2}}), npy(dictionary("<f8", "False", "(2, )"), doubles({1, 2})));
  EXPECT_EQ(npyBytes({{}, {7}}), npy(dictionary("<f8", "False", "()"), doubles({7})));
  EXPECT_THROW(npyBytes({{3, 2}, {1, 2, 3}}), Error);
}

TEST_F(NpzTest, WritesWhatItReads) {
  const std::map<std::string, NumberArray> arrays{
      {"polemeans", {{2, 3}, {1, 2, 3, 4, 5, 6}}}, {"empty", {{0, 3}, {}}}, {"one", {{}, {7}}}};
  writeNpz(path("w.npz"), arrays);
  const NpzFile npz(path("w.npz"));
  EXPECT_EQ(npz.names(), (std::vector<std::string>{"empty", "one", "polemeans"}));
  for (const auto& [name, array] : arrays) {
    EXPECT_EQ(npz.array(name).shape, array.shape);
    EXPECT_EQ(npz.array(name).values, array.values);
  }
  // An independent program accepts the file.
  const std::string check = "python3 -m zipfile -t " + path("w.npz").string() + " > " +
                            path("out.txt").string() + " 2>&1 && grep -q 'Done testing' " +
                            path("out.txt").string();
  if (std::system("python3 -c pass 2> /dev/null") == 0) {
    EXPECT_EQ(std::system(check.c_str()), 0);
  }
}

}  // namespace polemcl::test_npz
