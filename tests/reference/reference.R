# The reference numbers of this folder, by R: `make reference` computes them all again and fails when
# one has moved; `make reference WRITE=1` writes them. Run from this folder.

source("statistics.R")
DATASETS <- c("unbalanced", "partial", "ties", "small")
PUBLISHED <- "obrien_kaiser"
TOLERANCE <- 1e-6

moved <- function(old, new, path) {
  if (is.list(old) || is.list(new)) {
    if (length(old) != length(new) || !identical(sort(names(old)), sort(names(new))))
      return(paste0(path, ": other keys"))
    keys <- if (is.null(names(old))) seq_along(old) else names(old)
    return(unlist(lapply(keys, function(key) moved(old[[key]], new[[key]], paste0(path, ".", key)))))
  }
  if (is.null(old) && is.null(new)) return(NULL)
  if (length(old) > 1) return(unlist(lapply(seq_along(old), function(i) moved(old[i], new[i], paste0(path, "[", i, "]")))))
  same <- if (is.numeric(old) && is.numeric(new)) {
    tolerance <- if (grepl("lmm", path)) 1e-4 else TOLERANCE
    least <- if (grepl("anova.*\\.p$", path)) 0 else 1e-3
    is.finite(new) && abs(old - new) <= tolerance * max(least, abs(old), abs(new))
  } else identical(as.character(old), as.character(new))
  if (isTRUE(same)) NULL else paste0(path, ": ", format(old, digits = 12), " was, ", format(new, digits = 12), " is")
}

write <- identical(Sys.getenv("WRITE"), "1")
failures <- character(0)
for (name in c(DATASETS, PUBLISHED)) {
  cat(name, "...\n")
  found <- if (name == PUBLISHED) published() else reference_of(name)
  text <- toJSON(found, auto_unbox = TRUE, digits = NA, null = "null", na = "null")
  file <- paste0(name, ".json")
  if (write) writeLines(text, file)
  else failures <- c(failures, moved(fromJSON(file, simplifyVector = FALSE),
                                     fromJSON(text, simplifyVector = FALSE), name))
}
if (length(failures)) {
  cat(paste0("moved: ", failures, "\n"), sep = "")
  quit(status = 1)
}
cat(if (write) "written\n" else "every number is where it was\n")
