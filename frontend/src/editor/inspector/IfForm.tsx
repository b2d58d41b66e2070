/** If: its condition, and a button by which true and false change their steps. */
import { Button } from "@mantine/core";
import { ArrowLeftRight } from "lucide-react";
import { settle } from "../gestures/settle";
import { swapBranches } from "../model/framing";
import { useOpenProgram } from "../state/context";
import { ConditionForm } from "./ConditionForm";
import classes from "./inspector.module.css";
import { useStepEditor } from "./stepEditor";

export function IfForm() {
  const open = useOpenProgram();
  const { id, disabled } = useStepEditor();
  const { document, scene, t } = open;
  const empty = ["then", "else"].every((branch) => scene.tree.children(id, branch).length === 0);
  return (
    <>
      <ConditionForm field="condition" />
      <Button
        className={classes.between}
        variant="default"
        size="xs"
        leftSection={<ArrowLeftRight size={14} aria-hidden="true" />}
        disabled={disabled || empty}
        onClick={() => settle(open, swapBranches(document, id))}
      >
        {t("gesture.swap")}
      </Button>
    </>
  );
}
