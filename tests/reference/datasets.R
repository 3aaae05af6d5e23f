# Makes the made-up data sets of this folder: `Rscript datasets.R`, from this folder. The numbers mean
# nothing; each set has one difficulty that the statistics must get right.
#   partial.csv   some rounds have missing answers, some people have one round alone
#   ties.csv      quiz scores with many ties, also next to the cuts between groups
#   small.csv     two or three people in each of the nine cells

source("clustering.R")

levels3 <- c("C1", "C2", "C3")
groups3 <- c("LOW", "MED", "HIGH")

clip <- function(x, low, high) pmin(pmax(round(x), low), high)

made <- function(seed, sizes, spread) {
  set.seed(seed, kind = "Mersenne-Twister", normal.kind = "Inversion", sample.kind = "Rejection")
  rows <- list()
  person <- 0
  for (k in seq_along(groups3)) for (c in seq_along(levels3)) for (i in seq_len(sizes[k, c])) {
    person <- person + 1
    trait <- rnorm(1, 0, 10)
    liking <- rnorm(1, 0, 0.8)
    quiz <- clip(c(3, 10, 17)[k] + rnorm(1, 0, spread), 0, 20)
    for (a in 0:1) {
      lift <- 5 * (k - 2) * a - 3 * (c - 2) * (1 - a)
      items <- clip(3.2 + liking + 0.3 * a + rnorm(4, 0, 0.9), 1, 5)
      states <- clip(55 + lift + trait + rnorm(4, 0, 12), 1, 100)
      rows[[length(rows) + 1]] <- data.frame(
        participant = sprintf("P%03d", person), knowledge = groups3[k], complexity = levels3[c],
        adaptivity = c("static", "adaptive")[a + 1],
        victims = clip(11 + 2 * (k - 2) + trait / 6 + rnorm(1, 0, 2), 0, 20),
        engagement = states[1], confidence = states[2], frustration = states[3],
        confusion = states[4], pref1 = items[1], pref2 = items[2], pref3 = items[3],
        pref4 = items[4], quiz_static = quiz)
    }
  }
  do.call(rbind, rows)
}

written <- function(data, name) {
  quiz <- unique(data[c("participant", "quiz_static")])
  data$quiz_static <- NULL
  write.csv(data, paste0(name, ".csv"), row.names = FALSE, na = "", quote = FALSE)
  write.csv(quiz, paste0(name, "_quiz.csv"), row.names = FALSE, quote = FALSE)
}

# The groups of each set are those that the exact clustering finds, as in a study.
regrouped <- function(data) {
  quiz <- unique(data[c("participant", "quiz_static")])$quiz_static
  data$knowledge <- groups_of(data$quiz_static, three_clusters(quiz))
  data
}

partial <- made(41, matrix(c(6, 5, 7, 5, 8, 6, 7, 6, 5), 3), 1.2)
partial$engagement[c(3, 40, 77)] <- NA
partial$confidence[c(12, 13, 58)] <- NA
partial$pref2[c(8, 31, 90)] <- NA
partial$victims[c(21, 66)] <- NA
partial <- partial[-c(17, 52, 99), ]

ties <- made(43, matrix(c(5, 6, 5, 6, 5, 7, 5, 6, 6), 3), 0.9)
ties$quiz_static <- 2 * round(ties$quiz_static / 2)

small <- made(60, matrix(c(2, 3, 2, 3, 2, 3, 2, 3, 3), 3), 0.4)

written(regrouped(partial), "partial")
written(regrouped(ties), "ties")
written(regrouped(small), "small")
