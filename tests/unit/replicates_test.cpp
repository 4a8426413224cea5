#include "sampler/replicates.h"

#include "base/error.h"

#include <gtest/gtest.h>
#include <set>

namespace etendue {
namespace {

TEST(Replicates, DefaultIsTheSmallestDivisorThatIsEnough) {
  for (const auto& [samples, replicates] : {std::pair{1, 1},
                                            {2, 2},
                                            {7, 7},
                                            {8, 8},
                                            {9, 9},
                                            {12, 12},
                                            {16, 8},
                                            {17, 17},
                                            {20, 10},
                                            {64, 8},
                                            {100, 10},
                                            {256, 8},
                                            {513, 9},
                                            {1000, 20},
                                            {1024, 16},
                                            {1009, 1009},
                                            {5000, 100},
                                            {2147483647, 2147483647}})
    EXPECT_EQ(default_replicates(samples), replicates) << samples;
  for (int samples = 2; samples < 3000; ++samples) {
    const int replicates = default_replicates(samples);
    ASSERT_EQ(samples % replicates, 0);
    ASSERT_GE(replicates, 2);
    ASSERT_GE(64 * replicates, samples);
  }
}

TEST(Replicates, BlocksAreConsecutiveAndScramblingsApart) {
  std::set<std::uint64_t> streams;
  for (int replicate = 0; replicate < 4; ++replicate) {
    const ReplicatePlace block = replicate_place(ReplicatesBy::block, 7, 3, 5, replicate, 6);
    EXPECT_EQ(block.stream, sample_stream(7, 3, 5, 0));
    EXPECT_EQ(block.first_index, std::uint32_t(6 * replicate));
    const ReplicatePlace own = replicate_place(ReplicatesBy::scrambling, 7, 3, 5, replicate, 6);
    EXPECT_EQ(own.first_index, 0u);
    streams.insert(own.stream);
  }
  EXPECT_EQ(streams.size(), 4u);
}

TEST(Replicates, NamesAreThoseOfTheCommandLine) {
  for (const ReplicatesBy by : {ReplicatesBy::block, ReplicatesBy::scrambling})
    EXPECT_EQ(replicates_by_from_name(replicates_by_name(by)), by);
  EXPECT_THROW(replicates_by_from_name("blocks"), InputError);
}

}  // namespace
}  // namespace etendue
