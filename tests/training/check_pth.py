"""Loads GraphSAGENet.pth with Python's torch, computes every listed pair's logit as PyTorch Geometric would, and compares
with predictions.csv. Usage: check_pth.py DATA_FOLDER OUT_FOLDER. Exit code 77: torch is not installed."""
import csv
import sys

try:
    import torch
except ImportError:
    sys.exit(77)

data, out = sys.argv[1], sys.argv[2]
state = torch.load(f"{out}/GraphSAGENet.pth")
assert isinstance(state, dict) and all(isinstance(value, torch.Tensor) for value in state.values()), type(state)


def sage_conv(x, edges, name):
    """SAGEConv of PyTorch Geometric: mean of the sources of each target, lin_l with bias, lin_r without."""
    total = torch.zeros_like(x).index_add_(0, edges[1], x[edges[0]])
    count = torch.zeros(len(x)).index_add_(0, edges[1], torch.ones(edges.shape[1]))
    mean = total / count.clamp(min=1).unsqueeze(1)
    return (torch.nn.functional.linear(mean, state[f"{name}.lin_l.weight"], state[f"{name}.lin_l.bias"])
            + x @ state[f"{name}.lin_r.weight"].T)


def net(x, edges):
    x = sage_conv(sage_conv(x, edges, "graphsage.conv1"), edges, "graphsage.conv2")
    pairs = x[edges[0]] * x[edges[1]]
    hidden = torch.relu(torch.nn.functional.linear(pairs, state["nn.fc1.weight"], state["nn.fc1.bias"]))
    return torch.nn.functional.linear(hidden, state["nn.fc2.weight"], state["nn.fc2.bias"]).flatten()


def rows(file):
    with open(f"{data}/{file}", newline="") as stream:
        return list(csv.reader(stream))


edge_list = torch.tensor([[int(i) for i in row] for row in rows("edge_list.csv")])
x = torch.tensor([[float(i) for i in row] for row in rows("vehicle_features.csv")])
train_n = int(edge_list.shape[1] * (3 / 4))
expected = torch.cat([net(x, edge_list[:, :train_n + 1]), net(x, edge_list[:, train_n + 1:])])
with open(f"{out}/predictions.csv", newline="") as stream:
    given = torch.tensor([float(row["logit"]) for row in csv.DictReader(stream)])
assert given.shape == expected.shape, (given.shape, expected.shape)
worst = (given - expected).abs().max().item()
assert worst < 1e-5, worst
print("agrees within", worst)
