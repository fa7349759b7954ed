// A panel with a row for each value, which shows the row of a value that a person is led to (`model.found`).
import { model } from "#js/model.js";
import { Live, createRef } from "#js/view.js";

export class Finding extends Live {
  element = createRef();

  componentDidMount() {
    super.componentDidMount();
    this.find();
  }

  componentDidUpdate() {
    this.find();
  }

  // The state in which the row of a path can be seen.
  stateToShow(_path) {
    return {};
  }

  find() {
    const { found } = model;
    if (!found || found === this.found) return;
    this.found = found;
    this.setState(this.stateToShow(found.path), () => {
      for (const row of this.element.current.querySelectorAll("[data-path]")) row.classList.toggle("found", row.dataset.path === found.path);
      this.element.current.querySelector(".found")?.scrollIntoView({ block: "center" });
    });
  }
}
