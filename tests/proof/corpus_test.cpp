// Every program of the corpus gives the same bits by batches as one invocation at a time.
#include <gtest/gtest.h>

#include "tests/proof/corpus.h"

namespace vernier::proof {
namespace {

class Corpus : public testing::TestWithParam<std::string> {};

TEST_P(Corpus, IsTheSameByBatches) {
    const CorpusProgram program = loadCorpusProgram(GetParam());
    EXPECT_EQ(differences(program.subject), "");
}

std::string testName(const testing::TestParamInfo<std::string>& info) {
    std::string name = info.param;
    for (char& c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    return name;
}

INSTANTIATE_TEST_SUITE_P(Vertex, Corpus, testing::ValuesIn(corpusFiles(".vert")), testName);
INSTANTIATE_TEST_SUITE_P(Control, Corpus, testing::ValuesIn(corpusFiles(".tesc")), testName);
INSTANTIATE_TEST_SUITE_P(Evaluation, Corpus, testing::ValuesIn(corpusFiles(".tese")), testName);
INSTANTIATE_TEST_SUITE_P(Geometry, Corpus, testing::ValuesIn(corpusFiles(".geom")), testName);
INSTANTIATE_TEST_SUITE_P(Fragment, Corpus, testing::ValuesIn(corpusFiles(".frag")), testName);
INSTANTIATE_TEST_SUITE_P(Compute, Corpus, testing::ValuesIn(corpusFiles(".comp")), testName);

}  // namespace
}  // namespace vernier::proof
