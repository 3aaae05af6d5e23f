# Repeats the main tests of this folder's wide.csv with R alone: no packages are needed.
#   Rscript main_tests.R            prints them
#   Rscript main_tests.R OUT.csv    also writes them
# With two rounds a person, everything about adaptivity is a test of adaptive - static and all else
# a test of the sum of the rounds, each in a linear model with sum contrasts (Type III).

outcomes <- c(OUTCOMES)
wide <- read.csv("wide.csv", colClasses = c(participant = "character"))
wide$knowledge <- factor(wide$knowledge, levels = c("LOW", "MED", "HIGH"))
wide$complexity <- factor(wide$complexity, levels = c(LEVELS))
options(contrasts = c("contr.sum", "contr.poly"))

type3 <- function(y, data, suffix) {
  data$y <- y
  fit <- lm(if (nlevels(data$complexity) > 1) y ~ knowledge * complexity else y ~ knowledge, data)
  columns <- model.matrix(fit)
  which <- attr(columns, "assign")
  names <- c("(Intercept)", attr(terms(fit), "term.labels"))
  error <- sum(residuals(fit)^2)
  df2 <- df.residual(fit)
  do.call(rbind, lapply(seq_along(names), function(i) {
    without <- columns[, which != i - 1, drop = FALSE]
    ss <- sum(lm.fit(without, data$y)$residuals^2) - error
    df1 <- sum(which == i - 1)
    f <- (ss / df1) / (error / df2)
    effect <- if (suffix == "") names[i] else if (i == 1) suffix else paste0(names[i], ":", suffix)
    data.frame(effect = effect, df1 = df1, df2 = df2, F = f, p = pf(f, df1, df2, lower.tail = FALSE),
               partial_eta2 = ss / (ss + error))
  }))
}

results <- do.call(rbind, lapply(outcomes, function(outcome) {
  static <- wide[[paste0(outcome, "_static")]]
  adaptive <- wide[[paste0(outcome, "_adaptive")]]
  there <- !is.na(static) & !is.na(adaptive) & !is.na(wide$knowledge)
  data <- wide[there, ]
  if (any(table(data$knowledge, data$complexity) == 0)) return(NULL)
  both <- rbind(type3((static + adaptive)[there] / sqrt(2), data, ""),
                type3((adaptive - static)[there] / sqrt(2), data, "adaptivity"))
  cbind(outcome = outcome, n = sum(there), both)
}))
if (is.null(results)) {
  cat("No test: a cell of knowledge and level has nobody in it.\n")
  quit(status = 0)
}
print(format(results, digits = 4), row.names = FALSE)
out <- commandArgs(trailingOnly = TRUE)
if (length(out)) write.csv(results, out[1], row.names = FALSE)
