/** How much a run matters, when it may begin and by when it should be over. */
import { SegmentedControl, TextInput } from "@mantine/core";
import { PRIORITIES, type TermsForm } from "./runTerms";
import { useOpenProgram } from "../state/context";
import classes from "./dialogs.module.css";

export function RunTermsForm({ terms, onChange }: { terms: TermsForm; onChange: (terms: TermsForm) => void }) {
  const { t } = useOpenProgram();
  return (
    <>
      <div className={classes.labelled}>
        <span id="run-priority">{t("run_dialog.priority")}</span>
        <SegmentedControl
          fullWidth
          aria-labelledby="run-priority"
          data={PRIORITIES.map((value) => ({ value, label: t(`run_dialog.priorities.${value}`) }))}
          value={terms.priority}
          onChange={(value) => onChange({ ...terms, priority: value })}
        />
      </div>
      <div className={classes.pair}>
        <TextInput
          type="datetime-local"
          label={t("run_dialog.not_before")}
          value={terms.notBefore}
          onChange={(event) => onChange({ ...terms, notBefore: event.currentTarget.value })}
        />
        <TextInput
          type="datetime-local"
          label={t("run_dialog.deadline")}
          value={terms.deadline}
          onChange={(event) => onChange({ ...terms, deadline: event.currentTarget.value })}
        />
      </div>
    </>
  );
}
