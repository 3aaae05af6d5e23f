# The exact optimum of one-dimensional k-means with three clusters: every pair of cuts between
# distinct scores is tried. Where several are best, the lowest cuts.

three_clusters <- function(scores) {
  values <- sort(unique(scores))
  within <- function(x) sum((x - mean(x))^2)
  best <- list(total = Inf)
  second <- Inf
  for (i in seq_len(length(values) - 2)) for (j in (i + 1):(length(values) - 1)) {
    parts <- list(scores[scores <= values[i]],
                  scores[scores > values[i] & scores <= values[j]],
                  scores[scores > values[j]])
    total <- sum(sapply(parts, within))
    if (total < best$total - 1e-9) {
      second <- best$total
      best <- list(total = total, low = values[i], med = values[j], next_low = values[i + 1],
                   next_med = values[j + 1], centers = sapply(parts, mean),
                   sizes = sapply(parts, length))
    } else if (total < second) second <- total
  }
  best$second <- second
  best
}

group_names <- c("LOW", "MED", "HIGH")

groups_of <- function(scores, found) {
  group_names[1 + (scores > found$low) + (scores > found$med)]
}
