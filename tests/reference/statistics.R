# Every statistic of the reference, by R's own packages: functions alone. `reference.R` computes the
# reference with them, and `make bench` times them.

PACKAGES <- c("afex", "emmeans", "car", "lmerTest", "psych", "BayesFactor", "ordinal", "pbkrtest", "jsonlite")
absent <- PACKAGES[!vapply(PACKAGES, requireNamespace, logical(1), quietly = TRUE)]
if (length(absent)) {
  debian <- paste0("r-cran-", tolower(absent), collapse = " ")
  cat("The reference needs R packages that are not here: ", paste(absent, collapse = ", "),
      ".\nOn Debian and Ubuntu: sudo apt install ", debian, "\n", sep = "", file = stderr())
  quit(status = 2)
}
suppressPackageStartupMessages(for (package in PACKAGES) library(package, character.only = TRUE))
source("clustering.R")
options(contrasts = c("contr.sum", "contr.poly"), digits = 15, warn = 1)
emm_options(msg.interaction = FALSE, msg.nesting = FALSE)
afex_options(method_mixed = "S")

OUTCOMES <- c("victims", "engagement", "confidence", "frustration", "confusion", "preference")
STATES <- c("engagement", "confidence", "frustration", "confusion")
ITEMS <- paste0("pref", 1:4)
BETWEEN <- c("knowledge", "complexity", "knowledge:complexity")
EFFECTS <- c("(Intercept)", BETWEEN, "adaptivity", paste0(BETWEEN, ":adaptivity"))

in_order <- function(effect) gsub("complexity:adaptivity:knowledge", "knowledge:complexity:adaptivity", effect)
records <- function(frame) lapply(seq_len(nrow(frame)), function(i) as.list(frame[i, , drop = FALSE]))

read_long <- function(name) {
  data <- read.csv(paste0(name, ".csv"), colClasses = c(participant = "character"))
  data$preference <- rowSums(data[ITEMS])
  data$knowledge <- factor(data$knowledge, levels = group_names)
  data$complexity <- factor(data$complexity, levels = c("C1", "C2", "C3"))
  data$adaptivity <- factor(data$adaptivity, levels = c("static", "adaptive"))
  data$participant <- factor(data$participant)
  data[order(data$participant, data$adaptivity), ]
}

wide_of <- function(data, outcome) {
  both <- merge(data[data$adaptivity == "static", c("participant", "knowledge", "complexity", outcome)],
                data[data$adaptivity == "adaptive", c("participant", outcome)],
                by = "participant", suffixes = c(".s", ".a"))
  names(both)[4:5] <- c("s", "a")
  both[complete.cases(both), ]
}

# --- knowledge groups and reliability -------------------------------------------------------------

clustering_of <- function(name) {
  quiz <- read.csv(paste0(name, "_quiz.csv"), colClasses = c(participant = "character"))
  found <- three_clusters(quiz$quiz_static)
  list(withinss = found$total, second_best_withinss = found$second, max_low = found$low,
       max_med = found$med,
       boundaries = c((found$low + found$next_low) / 2, (found$med + found$next_med) / 2),
       centers = unname(found$centers),
       sizes = setNames(as.list(unname(found$sizes)), group_names),
       labels = setNames(as.list(groups_of(quiz$quiz_static, found)), quiz$participant))
}

alpha_of <- function(rows) {
  items <- rows[ITEMS]
  whole <- items[complete.cases(items), ]
  raw <- function(x, ...) suppressWarnings(psych::alpha(x, warnings = FALSE, ...)$total$raw_alpha)
  feldt <- psych::alpha.ci(raw(whole), n.obs = nrow(whole), n.var = length(ITEMS))
  list(rows_any = sum(rowSums(!is.na(items)) > 0), rows_complete = nrow(whole),
       listwise = raw(whole), pairwise = raw(items, use = "pairwise"),
       lower = feldt$lower.ci[[1]], upper = feldt$upper.ci[[1]])
}

# --- the mixed ANOVA, its cells and contrasts -----------------------------------------------------

anova_of <- function(wide) {
  mean_fit <- lm((s + a) / sqrt(2) ~ knowledge * complexity, wide)
  diff_fit <- lm((a - s) / sqrt(2) ~ knowledge * complexity, wide)
  long <- rbind(transform(wide, y = s, adaptivity = "static"),
                transform(wide, y = a, adaptivity = "adaptive"))
  long$adaptivity <- factor(long$adaptivity, levels = c("static", "adaptive"))
  fit <- suppressMessages(suppressWarnings(aov_ez(
    "participant", "y", long, between = c("knowledge", "complexity"), within = "adaptivity", type = 3)))
  table <- summary(fit)$univariate.tests
  ges <- function(observed) {
    shown <- suppressWarnings(anova(fit, es = c("ges", "pes"), observed = observed, intercept = TRUE))
    setNames(shown$ges, rownames(shown))
  }
  none <- ges(character(0)); knowledge <- ges("knowledge")
  rows <- lapply(EFFECTS, function(effect) {
    at <- table[effect, ]
    within <- grepl("adaptivity", effect)
    end <- function(below) eta_end(at[["F value"]], at[["num Df"]], at[["den Df"]], below)
    list(effect = effect, df1 = at[["num Df"]], df2 = at[["den Df"]], ss = at[["Sum Sq"]],
         pes.lower = end(0.95), pes.upper = end(0.05),
         ss_error = at[["Error SS"]], mse = at[["Error SS"]] / at[["den Df"]], F = at[["F value"]],
         p = at[["Pr(>F)"]], pes = at[["Sum Sq"]] / (at[["Sum Sq"]] + at[["Error SS"]]),
         ges = none[[effect]], ges_obs_knowledge = knowledge[[effect]],
         wilks = if (within) at[["Error SS"]] / (at[["Sum Sq"]] + at[["Error SS"]]) else NULL)
  })
  list(rows = rows, fit = fit, long = long, mean_fit = mean_fit, diff_fit = diff_fit)
}

root <- function(gap, lower, upper) uniroot(gap, c(lower, upper), extendInt = "yes", tol = 1e-10)$root

# The noncentrality of an observed t, or F, at which it has this probability below it.
noncentral_t <- function(t, df, below) root(function(ncp) pt(t, df, ncp) - below, t - 6, t + 6)
noncentral_f <- function(f, df1, df2, below) {
  if (pf(f, df1, df2) <= below) return(0)
  root(function(ncp) pf(f, df1, df2, max(ncp, 0)) - below, 0, f * df1 + 20)
}

eta_end <- function(f, df1, df2, below) {
  ncp <- noncentral_f(f, df1, df2, below)
  ncp / (ncp + df2)
}

# d is the estimate over the pooled standard deviation within cells, its interval that of the
# noncentral t.
with_d <- function(frame, sigma) {
  scale <- frame$SE / sigma
  frame$d <- frame$estimate / sigma
  frame$d.lower <- mapply(noncentral_t, frame$t.ratio, frame$df, 0.975) * scale
  frame$d.upper <- mapply(noncentral_t, frame$t.ratio, frame$df, 0.025) * scale
  frame
}

adjusted <- function(emm, by, sigma, what = "pairwise") {
  shown <- function(adjust) as.data.frame(summary(contrast(emm, what, by = by), infer = c(TRUE, TRUE), adjust = adjust))
  base <- shown("none")
  out <- with_d(base[setdiff(names(base), "p.value")], sigma(base))
  for (adjust in c("none", "bonf", "sidak", "holm")) out[[paste0("p_", adjust)]] <- shown(adjust)$p.value
  out
}

emm_rows <- function(fit, specs) records(as.data.frame(emmeans(fit, specs)))

plain <- function(frame) { frame[] <- lapply(frame, function(x) if (is.factor(x)) as.character(x) else x); frame }

type3 <- function(fit, ...) Anova(fit, type = 3, ...)

wrong_of <- function(made, wide) {
  data <- made$long
  two <- suppressMessages(suppressWarnings(aov_ez("participant", "y", data,
    between = c("knowledge", "complexity"), within = "adaptivity", type = 2)))
  treated <- lapply(list(mean = "mean_fit", diff = "diff_fit"), function(which) {
    y <- if (which == "mean_fit") (wide$s + wide$a) / sqrt(2) else (wide$a - wide$s) / sqrt(2)
    fit <- lm(y ~ knowledge * complexity, wide,
              contrasts = list(knowledge = "contr.treatment", complexity = "contr.treatment"))
    table <- type3(fit)
    setNames(table[["F value"]], rownames(table))
  })
  static <- split(wide$s, list(wide$knowledge, wide$complexity))
  welch <- do.call(c, lapply(group_names, function(k) lapply(list(c("C1", "C2"), c("C1", "C3"), c("C2", "C3")),
    function(pair) {
      test <- t.test(static[[paste0(k, ".", pair[1])]], static[[paste0(k, ".", pair[2])]])
      list(knowledge = k, contrast = paste(pair, collapse = " - "), t = test$statistic[[1]], p = test$p.value)
    })))
  f <- summary(two)$univariate.tests
  list(type2_F = setNames(as.list(f[EFFECTS, "F value"]), EFFECTS),
       treatment_coded_type3_F = c(
         setNames(as.list(treated$mean[BETWEEN]), BETWEEN),
         list(adaptivity = treated$diff[["(Intercept)"]]),
         setNames(as.list(treated$diff[BETWEEN]), paste0(BETWEEN, ":adaptivity"))),
       adaptivity_paired_t_squared_F = t.test(wide$a, wide$s, paired = TRUE)$statistic[[1]]^2,
       welch_pairs_static = welch)
}

# --- what the ANOVA assumes, and other tests of the same questions --------------------------------

assumptions_of <- function(wide) {
  cell <- interaction(wide$knowledge, wide$complexity)
  variables <- list(static = wide$s, adaptive = wide$a, diff = wide$a - wide$s)
  levene <- function(center) lapply(variables, function(y) {
    table <- leveneTest(y, cell, center = center)
    list(F = table[["F value"]][1], df1 = table$Df[1], df2 = table$Df[2], p = table[["Pr(>F)"]][1])
  })
  shapiro <- function(y) {
    test <- shapiro.test(residuals(lm(y ~ cell)))
    list(W = test$statistic[[1]], p = test$p.value)
  }
  list(levene_mean = levene(mean), levene_median = levene(median),
       shapiro_resid = list(mean = shapiro((wide$s + wide$a) / 2), diff = shapiro(wide$a - wide$s)))
}

hc3_of <- function(wide) {
  fit <- lm(a - s ~ knowledge * complexity, wide)
  table <- suppressMessages(Anova(fit, type = 3, white.adjust = "hc3"))
  names <- c("adaptivity", paste0(BETWEEN, ":adaptivity"))
  lapply(seq_along(names), function(i) list(effect = names[i], F = table$F[i], p = table[["Pr(>F)"]][i]))
}

paired_of <- function(wide) {
  d <- wide$a - wide$s
  test <- t.test(d)
  dz_end <- function(below) noncentral_t(test$statistic[[1]], length(d) - 1, below) / sqrt(length(d))
  # The bound is half a standard deviation of the static round, the smallest effect of interest.
  bound <- 0.5 * sd(wide$s)
  n <- length(d); se <- sd(d) / sqrt(n)
  low <- pt((mean(d) + bound) / se, n - 1, lower.tail = FALSE)
  high <- pt((mean(d) - bound) / se, n - 1)
  list(mean_diff = mean(d), sd_diff = sd(d), t = test$statistic[[1]], df = n - 1, p = test$p.value,
       lower.CL = test$conf.int[1], upper.CL = test$conf.int[2], dz = mean(d) / sd(d),
       dz.lower = dz_end(0.975), dz.upper = dz_end(0.025),
       bf10_jzs_r0707 = extractBF(ttestBF(d, rscale = sqrt(2) / 2), onlybf = TRUE)[[1]],
       tost_bound = bound, tost_p = max(low, high))
}

# A mixed model keeps partial rows. The denominator degrees of freedom belong to the sum-coded basis
# of contrasts, as `contest` gives them for it; `anova` makes a basis of its own, and on partial rows
# gives others.
lmm_of <- function(data, outcome) {
  rows <- data[!is.na(data[[outcome]]), ]
  rows$y <- rows[[outcome]]
  fit <- suppressMessages(lmer(y ~ knowledge * complexity * adaptivity + (1 | participant), rows,
    REML = TRUE, control = lmerControl(optimizer = "bobyqa", optCtrl = list(rhoend = 1e-10))))
  terms <- attr(terms(fit), "term.labels")
  columns <- attr(model.matrix(fit), "assign")
  tests <- lapply(seq_along(terms), function(i) {
    picked <- diag(length(columns))[columns == i, , drop = FALSE]
    test <- contestMD(fit, picked)
    kr <- KRmodcomp(fit, picked)$stats
    list(effect = terms[i], F = test[["F value"]], df1 = test$NumDF, df2 = test$DenDF, p = test[["Pr(>F)"]],
         F_kr = kr$Fstat, df2_kr = kr$ddf, p_kr = kr$p.value)
  })
  variances <- as.data.frame(VarCorr(fit))$vcov
  estimates <- coef(summary(fit))
  list(n_rows = nrow(rows), n_participants = length(unique(rows$participant)),
       var_participant = variances[1], var_resid = variances[2],
       reml_loglik = as.numeric(logLik(fit)), singular = isSingular(fit),
       fixef = lapply(rownames(estimates), function(term) list(
         term = term, est = estimates[term, "Estimate"], se = estimates[term, "Std. Error"])),
       anova = tests)
}

# `mistakes`: what common mistakes give, too.
outcome_of <- function(data, outcome, mistakes = TRUE) {
  wide <- wide_of(data, outcome)
  people <- length(unique(data$participant[!is.na(data[[outcome]]) | TRUE]))
  made <- anova_of(wide)
  fit <- made$fit
  cells <- do.call(rbind, lapply(group_names, function(k) do.call(rbind, lapply(levels(data$complexity), function(c) {
    here <- wide[wide$knowledge == k & wide$complexity == c, ]
    data.frame(knowledge = k, complexity = c, adaptivity = c("static", "adaptive"), n = nrow(here),
               mean = c(mean(here$s), mean(here$a)), sd = c(sd(here$s), sd(here$a)))
  }))))
  full <- emmeans(fit, ~ knowledge * complexity * adaptivity)
  diff_fit <- lm(a - s ~ knowledge * complexity, wide)
  diffs <- emmeans(diff_fit, ~ knowledge * complexity)
  residual <- function(y) sigma(lm(y ~ knowledge * complexity, wide))
  sigmas <- c(static = residual(wide$s), adaptive = residual(wide$a))
  of_round <- function(rows) sigmas[as.character(rows$adaptivity)]
  of_mean <- function(rows) residual((wide$s + wide$a) / 2)
  of_diff <- function(rows) residual(wide$a - wide$s)
  all36 <- adjusted(diffs, NULL, of_diff)
  all36$p_tukey <- as.data.frame(summary(contrast(diffs, "pairwise"), adjust = "tukey"))$p.value
  simple <- as.data.frame(summary(contrast(full, "revpairwise", by = c("knowledge", "complexity")), infer = c(TRUE, TRUE)))
  simple <- with_d(simple, of_diff(simple))
  marginal <- as.data.frame(confint(contrast(emmeans(fit, ~ adaptivity), "revpairwise"), level = 0.9))
  list(
    n = nrow(wide), n_dropped = people - nrow(wide), anova = made$rows, cells = records(cells),
    emm = list(knowledge = emm_rows(fit, "knowledge"), complexity = emm_rows(fit, "complexity"),
               adaptivity = emm_rows(fit, "adaptivity"),
               knowledge_complexity_adaptivity = records(plain(as.data.frame(full)))),
    posthoc_complexity_within_knowledge_by_round = records(plain(adjusted(full, c("knowledge", "adaptivity"), of_round))),
    posthoc_complexity_within_knowledge_avg = records(plain(adjusted(emmeans(fit, ~ complexity | knowledge), "knowledge", of_mean))),
    simple_adaptivity_within_cell = records(plain(simple)),
    posthoc_diff_knowledge_within_complexity = records(plain(adjusted(diffs, "complexity", of_diff))),
    posthoc_diff_all36 = records(plain(all36)),
    adaptivity_marginal = records(plain(marginal)),
    wrong = if (mistakes) wrong_of(made, wide), assumptions = assumptions_of(wide), hc3_diff = hc3_of(wide),
    paired = paired_of(wide), lmm = lmm_of(data, outcome))
}

# --- models with a random intercept on the logit scale --------------------------------------------

latent_of <- function(data) {
  test <- function(full, less) {
    chi2 <- 2 * (as.numeric(logLik(full)) - as.numeric(logLik(less)))
    list(chi2 = chi2, df = 4, p = pchisq(chi2, 4, lower.tail = FALSE))
  }
  items <- lapply(setNames(ITEMS, ITEMS), function(item) {
    rows <- data[!is.na(data[[item]]), ]
    rows$y <- factor(rows[[item]])
    full <- clmm(y ~ knowledge * complexity * adaptivity + (1 | participant), rows, nAGQ = -41)
    less <- clmm(y ~ (knowledge + complexity + adaptivity)^2 + (1 | participant), rows, nAGQ = -41)
    c(list(loglik = as.numeric(logLik(full))), test(full, less))
  })
  rows <- data[!is.na(data$victims), ]
  fit <- function(formula) suppressMessages(lme4::glmer(formula, rows, family = binomial, nAGQ = 25,
    control = lme4::glmerControl(optimizer = "bobyqa", optCtrl = list(rhoend = 1e-9))))
  full <- fit(cbind(victims, 20 - victims) ~ knowledge * complexity * adaptivity + (1 | participant))
  less <- fit(cbind(victims, 20 - victims) ~ (knowledge + complexity + adaptivity)^2 + (1 | participant))
  c(items, list(victims = test(full, less)))
}

reference_of <- function(name) {
  data <- read_long(name)
  outcomes <- lapply(setNames(OUTCOMES, OUTCOMES), function(outcome) outcome_of(data, outcome))
  p_of <- function(state, effect) Filter(function(row) row$effect == effect, outcomes[[state]]$anova)[[1]]$p
  holm <- lapply(setNames(EFFECTS, EFFECTS), function(effect)
    as.list(setNames(p.adjust(sapply(STATES, p_of, effect = effect), "holm"), STATES)))
  list(dataset = name, clustering = clustering_of(name),
       alpha = list(all = alpha_of(data), static = alpha_of(data[data$adaptivity == "static", ]),
                    adaptive = alpha_of(data[data$adaptivity == "adaptive", ])),
       outcomes = outcomes, holm_across_mental_states = holm,
       latent = if (name %in% c("unbalanced", "partial")) latent_of(data) else NULL)
}

# --- a published study of the same design: between x between x within ------------------------------

# O'Brien and Kaiser (1985): treatment x gender between people, and the phase of the measurement within
# them; here two of the three phases, their hours averaged, under the names of our factors.
published_of <- function(earlier, later) {
  hours <- read.csv("obrien_kaiser.csv", colClasses = c(id = "character"))
  data <- aggregate(value ~ id + treatment + gender + phase, hours[hours$phase %in% c(earlier, later), ], mean)
  names(data)[1] <- "participant"
  data$knowledge <- factor(data$treatment, levels = c("control", "A", "B"), labels = group_names)
  data$complexity <- factor(data$gender, levels = c("F", "M"), labels = c("C1", "C2"))
  data$adaptivity <- factor(data$phase, levels = c(earlier, later), labels = c("static", "adaptive"))
  data$participant <- factor(data$participant)
  data <- data[order(data$participant, data$adaptivity), ]
  wide <- wide_of(data, "value")
  diff_fit <- lm(a - s ~ knowledge * complexity, wide)
  gains <- adjusted(emmeans(diff_fit, ~ knowledge * complexity), "complexity", function(rows) sigma(diff_fit))
  list(anova = anova_of(wide)$rows, lmm = lmm_of(data, "value"),
       posthoc_diff_knowledge_within_complexity = records(plain(gains)))
}

published <- function() list(post = published_of("pre", "post"), fup = published_of("pre", "fup"))

# --- what `ana analyse` computes of one data set that R's packages compute too ---------------------

same_tests <- function(name) {
  data <- read_long(name)
  list(clustering = clustering_of(name), alpha = alpha_of(data),
       outcomes = lapply(OUTCOMES, function(outcome) outcome_of(data, outcome, mistakes = FALSE)))
}
