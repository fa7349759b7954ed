// Widgets of what robot code publishes as a table: choosers, PID controllers and other values, alerts, commands.
import { command, write } from "#js/connection.js";
import { topicOf, typeOf } from "#js/dashboard/topics.js";
import { plain } from "#js/format.js";
import { model } from "#js/model.js";
import { Alerts, CommandCard, ValuesCard } from "#js/panels/widgets.js";
import { Live, html } from "#js/view.js";

class TableWidget extends Live {
  parts = ["values", "paths", "shown", "hello", "choosers"];
  interval = 80;

  render({ path, title }) {
    model.need(this, [`${path}/`]);
    return this.content({ path, name: title, type: typeOf(path) }, model.shown.values);
  }

  /** @returns {any} */
  content(_folder, _values) {}
}

export class ValuesWidget extends TableWidget {
  content(folder, values) {
    return html`<${ValuesCard} folder=${folder} values=${values} />`;
  }
}

// From 2027 on, a ProfiledPIDController has most of them in a table of its own.
const GAINS = ["p", "i", "d", "f", "setpoint", "goal", "measurement", "error"].flatMap((name) => [name, `controller/${name}`]);

export class PidWidget extends TableWidget {
  content(folder, values) {
    return html`<${ValuesCard} folder=${folder} values=${values} only=${GAINS} />`;
  }
}

export class AlertsWidget extends TableWidget {
  content(folder, values) {
    return html`<${Alerts} folder=${folder} values=${values} />`;
  }
}

export class CommandWidget extends TableWidget {
  content(folder, values) {
    return html`<${CommandCard} folder=${folder} values=${values} />`;
  }
}

export class ChooserWidget extends TableWidget {
  content({ path, name }, values) {
    const chooser = model.past ? null : model.choosers.find((each) => each.name === topicOf(path));
    const options = chooser?.options ?? plain(values.get(`${path}/options`)) ?? [];
    const published = ["active", "selected/value", "default"].map((name) => values.get(`${path}/${name}`)); // the last two from 2027 on
    const active = chooser?.active ?? published.find((each) => each !== undefined) ?? "";
    const choose = (option) => (chooser ? command("choose", { chooser: chooser.name, option }) : write({ [`${path}/${model.hello.options.dashboard.choice}`]: option }));
    return html`<div class="chooser-widget"><select aria-label=${name} value=${active} disabled=${!model.mayWrite} onChange=${(event) => choose(event.target.value)}>
      ${options.map((option) => html`<option key=${option} value=${option} selected=${option === active}>${option}</option>`)}</select></div>`;
  }
}
