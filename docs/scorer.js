// The order of the search's results: pages with the words in their titles first, and how-tos before the reference.
var Scorer = {
  score: ([page, title, , , score]) => {
    const words = (new URLSearchParams(location.search).get("q") || "").toLowerCase().split(/\W+/);
    const inTitle = words.filter((word) => word.length > 2 && title.toLowerCase().includes(word.slice(0, 6)));
    const kind = page.startsWith("how_to/") || page.startsWith("tutorials/") ? 8 : page.includes("/api/") ? -8 : 0;
    return score + 10 * inTitle.length + kind;
  },
  objNameMatch: 11,
  objPartialMatch: 6,
  objPrio: { 0: 5, 1: 0, 2: -5 },
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
};
