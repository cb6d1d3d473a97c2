// A convenience only: a click shows a picture as large as the window, a click or Escape puts it back.
for (const card of document.querySelectorAll(".card")) {
  card.classList.add("can-enlarge");
  card.addEventListener("click", () => card.classList.toggle("enlarged"));
}
document.addEventListener("keydown", (event) => {
  if (event.key === "Escape") {
    document.querySelector(".enlarged")?.classList.remove("enlarged");
  }
});
